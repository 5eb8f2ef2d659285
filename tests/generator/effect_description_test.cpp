#include "description/effect_description.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/temporary_folder.hpp"

namespace idim::generator {

namespace {

const std::string effects_folder = std::string(IDIM_SOURCE_DIR) + "/templates/effects";

/// What the reader says about `text` in friction.yaml, without the folder.
std::string error_of_effect(const std::string& text) {
    const test::temporary_folder folder;
    try {
        read_effect(folder.write("friction.yaml", text));
    } catch (const input_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message.substr(folder.path().string().size() + 1);
    }
    return "no error";
}

/// An effect whose coefficients stand on line 4 and after.
std::string friction(const std::string& rest) {
    return "effect: friction\nper: joint\ntorque: F*qd\n" + rest;
}

TEST(EffectDescription, EveryEffectOfTheRepositoryIsReadAndSaysWhatItIsAbout) {
    int effects = 0;
    for (const auto& entry : std::filesystem::directory_iterator(effects_folder)) {
        if (entry.path().extension() == ".yaml") {
            const effect_description effect = read_effect(entry.path().string());
            EXPECT_EQ(effect.name, entry.path().stem().string());
            EXPECT_FALSE(effect.about.empty()) << effect.name;
            ++effects;
        }
    }
    EXPECT_GE(effects, 4);
}

TEST(EffectDescription, PlainJointEffectsAreThoseOfTheInverseDynamicModel) {
    const auto expect = [](const std::string& name, const std::string& torque, const std::string& coefficient,
                           bool not_negative) {
        const effect_description effect = read_effect(effects_folder + "/" + name + ".yaml");
        EXPECT_EQ(effect.scope, effect_scope::joint);
        EXPECT_EQ(effect.torque.text, torque);
        ASSERT_EQ(effect.linear.size(), 1u);
        EXPECT_EQ(effect.linear[0].name, coefficient);
        EXPECT_EQ(effect.linear[0].min.has_value(), not_negative);
        EXPECT_TRUE(effect.shape.empty());
    };
    expect("rotor_inertia", "Ia*qdd", "Ia", true);
    expect("viscous_friction", "Fv*qd", "Fv", true);
    expect("coulomb_friction", "Fc*sign(qd)", "Fc", true);
    expect("torque_offset", "off", "off", false);
}

TEST(EffectDescription, EveryFieldOfTheFormatIsRead) {
    const test::temporary_folder folder;
    const effect_description effect = read_effect(folder.write("friction.yaml",
                                                               "effect: friction\n"
                                                               "per: pair\n"
                                                               "torque: Fs * exp(-(qd_from/vs)^2) * sign(qd)\n"
                                                               "linear: {Fs: {unit: N*m, min: 0}, K: {unit: 1}}\n"
                                                               "shape: {vs: {unit: rad/s, range: [0.001, 1]}}\n"
                                                               "about: |\n"
                                                               "  friction that falls\n"
                                                               "  with speed\n"));
    EXPECT_EQ(effect.name, "friction");
    EXPECT_EQ(effect.scope, effect_scope::pair);
    EXPECT_EQ(effect.torque.text, "Fs * exp(-(qd_from/vs)^2) * sign(qd)");
    EXPECT_EQ(effect.torque.where.line, 3);
    ASSERT_EQ(effect.linear.size(), 2u);
    EXPECT_EQ(effect.linear[0].min, 0.0);
    EXPECT_EQ(effect.linear[1].name, "K");
    EXPECT_FALSE(effect.linear[1].min.has_value());
    ASSERT_EQ(effect.shape.size(), 1u);
    EXPECT_EQ(effect.shape[0].unit, "rad/s");
    EXPECT_EQ(effect.shape[0].range, (std::pair<double, double>{0.001, 1.0}));
    EXPECT_EQ(effect.about, "friction that falls with speed");
}

TEST(EffectDescription, MissingUnknownAndWrongFieldsAreRefused) {
    EXPECT_EQ(error_of_effect("per: joint\n"), "friction.yaml:1: effect: missing, expected the name of the effect");
    EXPECT_EQ(error_of_effect("effect: stiction\nper: joint\n"),
              "friction.yaml:1: effect: expected \"friction\", the name of the file, got \"stiction\"");
    EXPECT_EQ(error_of_effect("effect: friction\ntorque: F\n"),
              "friction.yaml:1: per: missing, expected joint, pair or robot");
    EXPECT_EQ(error_of_effect("effect: friction\nper: link\n"),
              "friction.yaml:2: per: expected joint, pair or robot, got \"link\"");
    EXPECT_EQ(error_of_effect("effect: friction\nper: robot\n"),
              "friction.yaml:1: torque: missing, expected an expression of the signals and coefficients");
    EXPECT_EQ(error_of_effect(friction("")), "friction.yaml:1: linear: missing, expected at least one coefficient");
    EXPECT_EQ(error_of_effect(friction("sort: x\n")),
              "friction.yaml:4: unknown key \"sort\", expected one of effect, per, acts_on, kind, torque, "
              "torque_without_temperature, per_log, state, linear, shape, about, proposed");
    EXPECT_EQ(error_of_effect(friction("kind: x\n")),
              "friction.yaml:4: kind: expected expression, delay, gain, elasticity, tilt or payload, got \"x\"");
    EXPECT_EQ(error_of_effect(friction("linear: {F: 1}\n")),
              "friction.yaml:4: linear.F: expected a map with keys among unit, min, got \"1\"");
    EXPECT_EQ(error_of_effect(friction("linear: {F: {min: 0}}\n")),
              "friction.yaml:4: linear.F.unit: missing, expected a unit such as N*m, or 1");
    EXPECT_EQ(error_of_effect(friction("linear: {F: {unit: 'N*/ x'}}\n")),
              "friction.yaml:4: linear.F.unit: expected a unit such as N*m, or 1, got \"N*/ x\"");
    EXPECT_EQ(error_of_effect(friction("linear: {F: {unit: N*m, min: low}}\n")),
              "friction.yaml:4: linear.F.min: expected a number, got \"low\"");
    EXPECT_EQ(error_of_effect(friction("linear: {F: {unit: N*m}}\nabout: [x]\n")),
              "friction.yaml:5: about: expected a sentence, got a list");
}

TEST(EffectDescription, ShapeCoefficientsHaveARange) {
    EXPECT_EQ(error_of_effect(friction("shape: {k: {unit: 1}}\n")),
              "friction.yaml:4: shape.k.range: missing, expected a list [lowest, highest]");
    EXPECT_EQ(error_of_effect(friction("shape: {k: {unit: 1, range: [1, 1]}}\n")),
              "friction.yaml:4: shape.k.range: expected [lowest, highest] with the lowest first");
    EXPECT_EQ(error_of_effect(friction("shape: {k: {unit: 1, range: [1, 2, 3]}}\n")),
              "friction.yaml:4: shape.k.range: expected a list [lowest, highest], got 3 entries");
    EXPECT_EQ(error_of_effect(friction("shape: {k: {unit: 1, range: [0, .inf]}}\n")),
              "friction.yaml:4: shape.k.range[2]: expected a finite number, got \".inf\"");
}

TEST(EffectDescription, CoefficientsDoNotTakeNamesThatMeanSomethingElse) {
    EXPECT_EQ(error_of_effect(friction("linear: {qd: {unit: 1}}\n")),
              "friction.yaml:4: linear.qd: \"qd\" has a meaning in expressions, expected another name");
    EXPECT_EQ(error_of_effect(friction("linear: {Ia1: {unit: 1}}\n")),
              "friction.yaml:4: linear.Ia1: \"Ia1\" is the name of a signal or parameter of a link, expected another "
              "name");
    EXPECT_EQ(error_of_effect(friction("linear: {F: {unit: 1}}\nshape: {F: {unit: 1, range: [0, 1]}}\n")),
              "friction.yaml:5: shape.F: \"F\" is already a linear coefficient");
    EXPECT_EQ(error_of_effect(friction("linear: {'F;': {unit: 1}}\n")),
              "friction.yaml:4: linear.\"F;\": expected a name of letters, digits and underscores, a letter first, at "
              "most 64 long, got \"F;\"");
}

class FindEffect : public ::testing::Test {
  protected:
    FindEffect() {
        robot_.file = folder_.write("arm/arm.yaml", "");
        use_.effect = "friction";
        use_.where = {robot_.file, 7, "effects[2]"};
        library_ = (folder_.path() / "library").string();
    }

    std::string write_friction(const std::string& place) const {
        return folder_.write(place + "/friction.yaml", friction("linear: {F: {unit: N*m*s/rad}}\n"));
    }

    test::temporary_folder folder_;
    robot_description robot_;
    effect_use use_;
    std::string library_;
};

TEST_F(FindEffect, LooksBesideTheRobotThenInItsEffectsThenInTheLibrary) {
    const std::string last = write_friction("library");
    EXPECT_EQ(find_effect(use_, robot_, library_).file, last);
    const std::string second = write_friction("arm/effects");
    EXPECT_EQ(find_effect(use_, robot_, library_).file, second);
    const std::string first = write_friction("arm");
    EXPECT_EQ(find_effect(use_, robot_, library_).file, first);
}

TEST_F(FindEffect, NamesTheLineOfTheRobotAndTheFoldersSearched) {
    const std::string arm = (folder_.path() / "arm").string();
    try {
        find_effect(use_, robot_, library_);
        FAIL() << "no error";
    } catch (const input_error& error) {
        EXPECT_EQ(error.what(), robot_.file + ":7: effects[2]: no effect \"friction\", searched " + arm + ", " + arm +
                                    "/effects, " + library_);
    }
}

}  // namespace

}  // namespace idim::generator
