#include "description/effect_insertion.hpp"

#include <gtest/gtest.h>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

const effect_item ripple{"torque_ripple", {"j2"}, {}, {{"k", 17.5}}};

TEST(EffectInsertion, FlowListKeepsWhatStandsAroundIt) {
    EXPECT_EQ(
        with_effects("name: a   # [not here]\neffects: [viscous_friction, {effect: spring, joints: [j1]}]   # two\n"
                     "gravity: [0, 0, 0]\n",
                     {ripple}, "a.yaml"),
        "name: a   # [not here]\neffects: [viscous_friction, {effect: spring, joints: [j1]}, {effect: "
        "torque_ripple, joints: [j2], shape: {k: 17.5}}]   # two\ngravity: [0, 0, 0]\n");
}

TEST(EffectInsertion, BlockListKeepsItsCommentsAndIndentation) {
    EXPECT_EQ(with_effects("effects:\n  - viscous_friction   # all\n  - {effect: spring,\n     joints: [j1]}   # one\n"
                           "control: {law: pid}\n",
                           {ripple, {"coupling_friction", {"j1"}, {"j2"}, {}}}, "a.yaml"),
              "effects:\n  - viscous_friction   # all\n  - {effect: spring,\n     joints: [j1]}   # one\n"
              "  - {effect: torque_ripple, joints: [j2], shape: {k: 17.5}}\n"
              "  - {effect: coupling_friction, joints: [j1], from: [j2]}\ncontrol: {law: pid}\n");
}

TEST(EffectInsertion, DescriptionWithoutEffectsGetsAList) {
    EXPECT_EQ(with_effects("name: a", {ripple}, "a.yaml"),
              "name: a\neffects:\n  - {effect: torque_ripple, joints: [j2], shape: {k: 17.5}}\n");
    EXPECT_EQ(with_effects("effects: []\n", {ripple}, "a.yaml"),
              "effects: [{effect: torque_ripple, joints: [j2], shape: {k: 17.5}}]\n");
}

TEST(EffectInsertion, NothingToAddChangesNothing) {
    EXPECT_EQ(with_effects("anything: [", {}, "a.yaml"), "anything: [");
}

TEST(EffectInsertion, EffectsThatAreNoListAreRefused) {
    try {
        with_effects("name: a\neffects: all\n", {ripple}, "a.yaml");
        FAIL() << "accepted";
    } catch (const input_error& error) {
        EXPECT_STREQ(error.what(), "a.yaml:2: effects: expected a list");
    }
}

}  // namespace

}  // namespace idim::generator
