// The judge judged: findings whose worth is plain.
#include "undeclared/score.hpp"

#include <gtest/gtest.h>

namespace idim::undeclared {

namespace {

using nlohmann::json;

/// Two joints; a ripple at the second is missing.
bench_case ripple_case() {
    bench_case made;
    made.class_name = "torque_ripple";
    made.rho = 0.5;
    made.robot.rows.resize(2);
    made.effects = {{"torque_ripple", "torque_ripple", 1, -1, {{"Ac", 3.0}, {"As", 4.0}}, {{"k", 10.0}}}};
    made.rho_made = {0.5};
    made.shows_at = {1};
    return made;
}

json errors(double first, double second) {
    const double total = std::hypot(first, second) / 10.0;
    return {{"relative_error", total},
            {"joints",
             {{{"joint", "j1"}, {"rms", first}, {"relative_error", 0.1}},
              {{"joint", "j2"}, {"rms", second}, {"relative_error", 0.1}}}}};
}

json step(const std::string& effect, const std::string& joint) {
    return {{"effect", effect}, {"joints", {joint}},         {"parameters", json::object()},
            {"p_value", 1e-9},  {"explained_fraction", 0.9}, {"confusable_with", json::array()}};
}

finding finding_with(const json& steps, const json& unexplained = json::array()) {
    finding found;
    read_refinement({{"verdict", steps.empty() ? "no_missing_effect" : "effects_added"},
                     {"before", {{"identification", errors(1.0, 2.0)}, {"validation", errors(1.0, 2.0)}}},
                     {"after", {{"identification", errors(1.0, 1.1)}, {"validation", errors(1.0, 1.1)}}},
                     {"steps", steps},
                     {"unexplained", unexplained}},
                    found);
    return found;
}

score judged(const json& steps) {
    return score_of(ripple_case(), finding_with(steps), errors_in(errors(1.0, 1.0)));
}

TEST(UndeclaredScore, RightNameAtTheRightJointIsNamed) {
    const score result = judged(json::array({step("torque_ripple", "j2")}));
    EXPECT_TRUE(result.effects[0].exactly);
    EXPECT_TRUE(result.effects[0].right_joint);
    EXPECT_EQ(result.surplus, 0);
    EXPECT_FALSE(result.worse);
    EXPECT_NEAR(result.ratio, std::hypot(1.0, 1.1) / std::hypot(1.0, 1.0), 1e-12);
    EXPECT_NEAR(result.rho_in_tool_band, std::sqrt(3.0), 1e-12);
}

TEST(UndeclaredScore, WrongJointIsNotNamedAndSurplus) {
    const score result = judged(json::array({step("torque_ripple", "j1")}));
    EXPECT_FALSE(result.effects[0].named);
    EXPECT_FALSE(result.effects[0].right_joint);
    EXPECT_EQ(result.surplus, 1);
}

TEST(UndeclaredScore, FamilyThatHasItCountsAsNamed) {
    json found = step("spring", "j2");
    found["confusable_with"] = json::array({{{"effect", "torque_ripple"}, {"joints", "j2"}}});
    const score result = judged(json::array({found}));
    EXPECT_TRUE(result.effects[0].named);
    EXPECT_FALSE(result.effects[0].exactly);
    EXPECT_EQ(result.surplus, 0);
}

TEST(UndeclaredScore, WhatComesBesideTheRightOneIsSurplus) {
    const score result =
        judged(json::array({step("torque_ripple", "j2"), step("torque_ripple", "j2"), step("backlash", "j1")}));
    EXPECT_TRUE(result.effects[0].named);
    EXPECT_EQ(result.surplus, 2);
}

TEST(UndeclaredScore, AmplitudeAndWaveNumberAreCompared) {
    json found = step("torque_ripple", "j2");
    found["parameters"] = {{"Ac", {{"value", 0.0}, {"std", 0.1}}},
                           {"As", {{"value", 5.15}, {"std", 0.1}}},
                           {"k", {{"value", 10.6}, {"std", 0.1}}}};
    const score result = judged(json::array({found}));
    EXPECT_EQ(result.effects[0].sizes, 1);  // one amplitude, 5 by another phase
    EXPECT_EQ(result.effects[0].sizes_right, 1);
    EXPECT_EQ(result.effects[0].shapes, 1);
    EXPECT_EQ(result.effects[0].shapes_right, 0);  // 6 % off
}

TEST(UndeclaredScore, NoResultNamesNothing) {
    const score result = score_of(ripple_case(), finding{}, model_errors{});
    EXPECT_FALSE(result.effects[0].named);
    EXPECT_EQ(result.named_as, "failed");
}

TEST(UndeclaredScore, StructureNeedsTheJointAndTheOtherSignal) {
    bench_case made = ripple_case();
    made.effects = {{"position_product", "", 1, 0, {{"c", 1.0}}, {}}};
    const auto found = [&](const char* joint, const json& signals) {
        const json entry = {{"joint", joint}, {"signals", signals}, {"explained_fraction", 0.5}, {"proposed", nullptr}};
        return score_of(made, finding_with(json::array(), json::array({entry})), errors_in(errors(1.0, 1.0)))
            .structure_found;
    };
    EXPECT_TRUE(found("j2", {"q1", "q2"}));
    EXPECT_FALSE(found("j1", {"q1", "q2"}));
    EXPECT_FALSE(found("j2", {"q2"}));
}

TEST(UndeclaredScore, CouplingIsTheSameWhicheverJointComesFirst) {
    bench_case made = ripple_case();
    made.effects = {{"joint_coupling", "joint_coupling", 1, 0, {{"Iac", 1.0}}, {}}};
    json coupling = step("joint_coupling", "j1");
    coupling["joints"] = json::array({"j1", "j2"});
    EXPECT_TRUE(score_of(made, finding_with(json::array({coupling})), errors_in(errors(1.0, 1.0))).effects[0].exactly);
}

}  // namespace

}  // namespace idim::undeclared
