#include "description/robot_description.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

robot_description read_description(const std::string& text) {
    const test::temporary_folder folder;
    return read_robot(folder.write("robot.yaml", text));
}

/// What the reader says about `text`, without the folder: "robot.yaml:3: field: message".
std::string error_of_robot(const std::string& text) {
    const test::temporary_folder folder;
    const std::string file = folder.write("robot.yaml", text);
    try {
        read_robot(file);
    } catch (const input_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(file, 0), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message.substr(folder.path().string().size() + 1);
    }
    return "no error";
}

/// Two revolute joints on lines 3 and 4; `rest` starts on line 5.
std::string two_joints(const std::string& rest) {
    return "name: arm\n"
           "joints:\n"
           "  - {name: j1, theta: q}\n"
           "  - {name: j2, d: 0.5, theta: q}\n" +
           rest;
}

/// One joint whose row, on line 3, ends with `entries`.
std::string one_joint(const std::string& entries) {
    return "name: arm\njoints:\n  - {" + entries + "}\n";
}

std::vector<std::string> joint_names(const robot_description& robot) {
    std::vector<std::string> names;
    for (const joint_description& joint : robot.joints) {
        names.push_back(joint.name);
    }
    return names;
}

}  // namespace

TEST(RobotDescription, EveryRobotOfTheRepositoryIsReadAndNamedAsItsFolder) {
    int robots = 0;
    for (const auto& folder : std::filesystem::directory_iterator(test::source_folder + "/robots")) {
        if (folder.is_directory()) {
            const std::string name = folder.path().filename().string();
            const robot_description robot = read_robot((folder.path() / (name + ".yaml")).string());
            EXPECT_EQ(robot.name, name);
            EXPECT_TRUE(std::filesystem::exists(folder.path() / "README.md")) << name;
            ++robots;
        }
    }
    EXPECT_GE(robots, 9);
}

TEST(RobotDescription, ScaraIsListedAsWritten) {
    EXPECT_EQ(to_string(read_robot(test::source_folder + "/robots/scara/scara.yaml")),
              "name: scara\n"
              "gravity: [0, 0, 0]\n"
              "constants:\n"
              "  L: 0.5\n"
              "joints:\n"
              "  - {name: j1, type: revolute, antecedent: base, gamma: 0, b: 0, alpha: 0, d: 0, theta: q, r: 0}\n"
              "  - {name: j2, type: revolute, antecedent: j1, gamma: 0, b: 0, alpha: 0, d: L, theta: q, r: 0}\n"
              "effects:\n"
              "  - {effect: rotor_inertia, joints: [j1]}\n"
              "  - {effect: direct_drive_rotor, joints: [j2], from: [j1]}\n"
              "  - {effect: viscous_friction, joints: [j1, j2]}\n"
              "  - {effect: coulomb_friction, joints: [j1, j2]}\n"
              "control: {law: pd_cascade, rate: 200, delay: 0, wn: [1, 10], zeta: [1, 1]}\n");
}

TEST(RobotDescription, EveryFieldOfTheFormatIsRead) {
    const robot_description robot = read_description(
        "name: arm\n"
        "gravity: [0, -g, 0]\n"
        "constants: {g: 9.81, L: 2*0.25}\n"
        "joints:\n"
        "  - {name: lift, type: prismatic, alpha: pi/2, gamma: 0.1, b: L, r: q + L,\n"
        "     limits: {position: [-1, 2], velocity: 3, effort: 4}, drive_gain: -35.5}\n"
        "  - {name: turn, antecedent: base, theta: q + pi/2}\n"
        "  - {name: tool, type: fixed, d: L}\n"
        "effects:\n"
        "  - viscous_friction\n"
        "  - {effect: stribeck_friction, joints: [turn], shape: {vs: 0.03}}\n"
        "  - {effect: coupling_friction, joints: [turn], from: [lift]}\n"
        "control: {law: p_position, rate: 1000, delay: 0.002, kp: 7, kv: [1, 2]}\n"
        "parameters: {ZZ1: 1.2}\n");
    EXPECT_EQ(to_string(robot),
              "name: arm\n"
              "gravity: [0, -g, 0]\n"
              "constants:\n"
              "  g: 9.81\n"
              "  L: 2*0.25\n"
              "joints:\n"
              "  - {name: lift, type: prismatic, antecedent: base, gamma: 0.1, b: L, alpha: pi/2, d: 0, theta: 0, "
              "r: q + L, limits: {position: [-1, 2], velocity: 3, effort: 4}, drive_gain: -35.5}\n"
              "  - {name: turn, type: revolute, antecedent: base, gamma: 0, b: 0, alpha: 0, d: 0, "
              "theta: q + pi/2, r: 0}\n"
              "  - {name: tool, type: fixed, antecedent: turn, gamma: 0, b: 0, alpha: 0, d: L, theta: 0, r: 0}\n"
              "effects:\n"
              "  - {effect: viscous_friction, joints: [lift, turn]}\n"
              "  - {effect: stribeck_friction, joints: [turn], shape: {vs: 0.03}}\n"
              "  - {effect: coupling_friction, joints: [turn], from: [lift]}\n"
              "control: {law: p_position, rate: 1000, delay: 0.002, kp: [7, 7], kv: [1, 2]}\n"
              "parameters:\n"
              "  ZZ1: 1.2\n");
}

TEST(RobotDescription, DefaultsAreGravityDownNumberedJointsAndNoEffects) {
    const robot_description robot = read_description("name: arm\njoints: [{theta: q}, {theta: q}]\n");
    EXPECT_EQ(robot.gravity[2].text, "-9.81");
    EXPECT_EQ(joint_names(robot), (std::vector<std::string>{"j1", "j2"}));
    EXPECT_TRUE(robot.effects.empty());
    EXPECT_FALSE(robot.control.has_value());
}

TEST(RobotDescription, EntriesKnowTheirLineAndField) {
    const robot_description robot = read_description(two_joints(""));
    EXPECT_EQ(robot.joints[1].theta.where.line, 4);
    EXPECT_EQ(robot.joints[1].theta.where.field, "joints[2].theta");
    EXPECT_EQ(robot.joints[1].r.where.field, "joints[2].r");
}

TEST(RobotDescription, AntecedentsComeFirstAndOtherwiseTheWrittenOrderIsKept) {
    const robot_description robot = read_description(
        "name: tree\n"
        "joints:\n"
        "  - {name: hand, antecedent: arm, theta: q}\n"
        "  - {name: left, antecedent: base, theta: q}\n"
        "  - {name: arm, antecedent: base, theta: q}\n"
        "  - {name: tip, antecedent: left, theta: q}\n"
        "control: {law: pd, kp: [1, 2, 3, 4]}\n");
    EXPECT_EQ(joint_names(robot), (std::vector<std::string>{"left", "arm", "hand", "tip"}));
    EXPECT_EQ(robot.joints[0].antecedent, -1);
    EXPECT_EQ(robot.joints[1].antecedent, -1);
    EXPECT_EQ(robot.joints[2].antecedent, 1);
    EXPECT_EQ(robot.joints[3].antecedent, 0);
    EXPECT_EQ(robot.control->values.at("kp"), (std::vector<double>{2, 3, 1, 4})) << "lists follow the written rows";
}

TEST(RobotDescription, UnknownAndCyclicAntecedentsAreRefused) {
    EXPECT_EQ(error_of_robot(one_joint("theta: q, antecedent: j9")),
              "robot.yaml:3: joints[1].antecedent: expected the name of a joint, or base, got \"j9\"");
    EXPECT_EQ(error_of_robot("name: arm\n"
                             "joints:\n"
                             "  - {name: j1, theta: q}\n"
                             "  - {name: j2, antecedent: j3, theta: q}\n"
                             "  - {name: j3, antecedent: j2, theta: q}\n"
                             "  - {name: j4, antecedent: j3, theta: q}\n"),
              "robot.yaml:4: joints[2].antecedent: antecedents form a cycle: j2 -> j3 -> j2");
    EXPECT_EQ(error_of_robot(one_joint("name: j1, theta: q, antecedent: j1")),
              "robot.yaml:3: joints[1].antecedent: antecedents form a cycle: j1 -> j1");
}

TEST(RobotDescription, NamesThatAreNoIdentifiersAreRefusedOnOneLine) {
    const std::string rule =
        "expected a name of letters, digits and underscores, a letter first, at most 64 long, got ";
    const auto joint = [](const std::string& name) { return error_of_robot(one_joint("theta: q, name: " + name)); };
    EXPECT_EQ(joint("\"j1; system(0)\""), "robot.yaml:3: joints[1].name: " + rule + "\"j1; system(0)\"");
    EXPECT_EQ(joint("'a\"b'"), "robot.yaml:3: joints[1].name: " + rule + "\"a\\\"b\"");
    EXPECT_EQ(joint("'*/'"), "robot.yaml:3: joints[1].name: " + rule + "\"*/\"");
    EXPECT_EQ(joint("\"a\\nb\""), "robot.yaml:3: joints[1].name: expected a joint name, got \"a\\x0ab\"");
    EXPECT_EQ(joint("\"j\xc3\xa4\""), "robot.yaml:3: joints[1].name: " + rule + "\"j\\xc3\\xa4\"");
    EXPECT_EQ(joint("1j"), "robot.yaml:3: joints[1].name: " + rule + "\"1j\"");
    EXPECT_EQ(joint(std::string(65, 'a')),
              "robot.yaml:3: joints[1].name: " + rule + "\"" + std::string(40, 'a') + "...\"");
    EXPECT_EQ(joint(std::string(64, 'a')), "no error");
    EXPECT_EQ(joint("while"),
              "robot.yaml:3: joints[1].name: \"while\" has a meaning in generated code, expected another name");
    EXPECT_EQ(joint("[a]"), "robot.yaml:3: joints[1].name: expected a joint name, got a list");
    EXPECT_EQ(error_of_robot("name: ../x\njoints: [{theta: q}]\n"), "robot.yaml:1: name: " + rule + "\"../x\"");
    EXPECT_EQ(error_of_robot(two_joints("effects: [../../etc/x]\n")),
              "robot.yaml:5: effects[1]: " + rule + "\"../../etc/x\"");
    EXPECT_EQ(error_of_robot(two_joints("constants: {\"L\\n\": 1}\n")),
              "robot.yaml:5: constants.\"L\\x0a\": " + rule + "\"L\\x0a\"");
}

TEST(RobotDescription, ConstantsDoNotTakeNamesOfSignalsFunctionsOrParameters) {
    for (const char* name : {"q", "pi", "sin", "tau", "chi", "M", "XX"}) {
        EXPECT_EQ(error_of_robot(two_joints(std::string("constants: {") + name + ": 1}\n")),
                  std::string("robot.yaml:5: constants.") + name + ": \"" + name +
                      "\" has a meaning in expressions, expected another name");
    }
    for (const char* name : {"XX1", "ZZ2", "M3", "Ia1", "ZZ1R", "off12", "q3", "tau1"}) {
        EXPECT_EQ(error_of_robot(two_joints(std::string("constants: {") + name + ": 1}\n")),
                  std::string("robot.yaml:5: constants.") + name + ": \"" + name +
                      "\" is the name of a signal or parameter of a link, expected another name");
    }
    EXPECT_EQ(error_of_robot(two_joints("constants: {L: 1, D3: 1, RL4: 1, l3x: 1, R: 1, M3b: 1}\n")), "no error");
}

TEST(RobotDescription, JointNamesAreUnique) {
    EXPECT_EQ(error_of_robot("name: arm\njoints:\n  - {name: j2, theta: q}\n  - {theta: q}\n"),
              "robot.yaml:4: joints[2].name: joint \"j2\" is already on line 3");
    EXPECT_EQ(error_of_robot("name: arm\njoints:\n  - {name: a, theta: q}\n  - {name: A, theta: q}\n"), "no error");
}

TEST(RobotDescription, AKeyThatIsUnknownOrWrittenTwiceIsRefused) {
    EXPECT_EQ(
        error_of_robot(two_joints("gravitation: [0, 0, 0]\n")),
        "robot.yaml:5: unknown key \"gravitation\", expected one of name, gravity, constants, joints, loops, effects, "
        "control, parameters, urdf");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, alfa: 0")),
              "robot.yaml:3: joints[1]: unknown key \"alfa\", expected one of name, type, antecedent, gamma, b, alpha, "
              "d, theta, r, massless, limits, drive_gain");
    EXPECT_EQ(error_of_robot(two_joints("name: again\n")), "robot.yaml:5: duplicate key \"name\", first on line 1");
    EXPECT_EQ(error_of_robot(two_joints("constants:\n  L: 1\n  L: 2\n")),
              "robot.yaml:7: constants: duplicate key \"L\", first on line 6");
    EXPECT_EQ(error_of_robot(two_joints("constants:\n  [a]: 1\n")),
              "robot.yaml:6: constants: expected a plain name as key, got a list");
}

TEST(RobotDescription, TheEntryThatHoldsTheJointVariableIsRequired) {
    EXPECT_EQ(error_of_robot(one_joint("alpha: 0")),
              "robot.yaml:3: joints[1].theta: missing, expected an expression of q such as \"q\" or \"q + pi/2\"");
    EXPECT_EQ(error_of_robot(one_joint("type: prismatic, theta: 0")),
              "robot.yaml:3: joints[1].r: missing, expected an expression of q such as \"q\" or \"q + pi/2\"");
}

TEST(RobotDescription, EntriesOfARowAreFiniteNumbersOrExpressions) {
    const std::string where = "robot.yaml:3: joints[1].d: ";
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: .nan")),
              where + "expected a finite number or an expression, got \".nan\"");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: -.inf")),
              where + "expected a finite number or an expression, got \"-.inf\"");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: 1e999")),
              where + "expected a finite number or an expression, got \"1e999\"");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: [1]")), where + "expected a number or an expression, got a list");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: ")), where + "expected a number or an expression, got nothing");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: \"1\\n2\"")),
              where + "expected a number or an expression, got \"1\\x0a2\"");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, d: " + std::string(5000, '1') + "x")),
              where + "expected an expression of at most 4096 characters, got \"" + std::string(40, '1') + "...\"");
}

TEST(RobotDescription, AnUnknownJointTypeIsRefusedWithTheKnownOnes) {
    EXPECT_EQ(error_of_robot(one_joint("theta: q, type: spherical")),
              "robot.yaml:3: joints[1].type: expected revolute, prismatic or fixed, got \"spherical\"");
}

TEST(RobotDescription, LimitsAndGainsAreChecked) {
    const auto limits = [](const std::string& text) { return error_of_robot(one_joint("theta: q, limits: " + text)); };
    const std::string where = "robot.yaml:3: joints[1].limits";
    EXPECT_EQ(limits("3"), where + ": expected a map with keys among position, velocity, effort, got \"3\"");
    EXPECT_EQ(limits("{position: 1}"), where + ".position: expected a list [lowest, highest], got \"1\"");
    EXPECT_EQ(limits("{position: [1]}"), where + ".position: expected a list [lowest, highest], got 1 entries");
    EXPECT_EQ(limits("{position: [2, 1]}"), where + ".position: expected [lowest, highest] with the lowest first");
    EXPECT_EQ(limits("{position: [a, 1]}"), where + ".position[1]: expected a number, got \"a\"");
    EXPECT_EQ(limits("{velocity: 0}"), where + ".velocity: expected a positive number, got \"0\"");
    EXPECT_EQ(limits("{effort: .inf}"), where + ".effort: expected a finite number, got \".inf\"");
    EXPECT_EQ(limits("{force: 1}"), where + ": unknown key \"force\", expected one of position, velocity, effort");
    EXPECT_EQ(error_of_robot(one_joint("theta: q, drive_gain: 0")),
              "robot.yaml:3: joints[1].drive_gain: expected a number other than zero, got \"0\"");
    EXPECT_EQ(error_of_robot(two_joints("  - {type: fixed, drive_gain: 2}\n")),
              "robot.yaml:5: joints[3].drive_gain: a fixed joint has no limits and no drive_gain");
}

TEST(RobotDescription, TheListOfJointsIsBounded) {
    EXPECT_EQ(error_of_robot("name: arm\n"), "robot.yaml:1: joints: missing, expected a list of joints");
    EXPECT_EQ(error_of_robot("name: arm\njoints: []\n"),
              "robot.yaml:2: joints: expected at least one joint, got an empty list");
    EXPECT_EQ(error_of_robot("name: arm\njoints:\n"),
              "robot.yaml:2: joints: expected a list of joints such as [{alpha: 0, d: 0, theta: q, r: 0}], got "
              "nothing");
    EXPECT_EQ(error_of_robot(one_joint("type: fixed")),
              "robot.yaml:3: joints: every joint is fixed, expected a revolute or prismatic one");
    std::string text = "name: arm\njoints:\n";
    for (int j = 0; j < 200; ++j) {
        text += "  - {theta: q}\n";
    }
    EXPECT_EQ(error_of_robot(text), "no error");
    EXPECT_EQ(error_of_robot(text + "  - {theta: q}\n"), "robot.yaml:3: joints: expected at most 200 joints, got 201");
}

TEST(RobotDescription, GravityHasThreeEntries) {
    EXPECT_EQ(error_of_robot(two_joints("gravity: [0, -9.81]\n")),
              "robot.yaml:5: gravity: expected three entries [m/s^2] such as [0, 0, -9.81], got 2");
    EXPECT_EQ(error_of_robot(two_joints("gravity: -9.81\n")),
              "robot.yaml:5: gravity: expected three entries [m/s^2] such as [0, 0, -9.81], got \"-9.81\"");
}

TEST(RobotDescription, EffectsNameJointsThatMove) {
    const auto effect = [](const std::string& text) {
        return error_of_robot(two_joints("effects:\n  - " + text + "\n"));
    };
    const std::string where = "robot.yaml:6: effects[1]";
    EXPECT_EQ(effect("{effect: spring, joints: [j7]}"),
              where + ".joints[1]: expected the name of a joint of this robot, got \"j7\"");
    EXPECT_EQ(effect("{effect: spring, joints: j1}"),
              where + ".joints: expected a list of joint names such as [j1], got \"j1\"");
    EXPECT_EQ(effect("{effect: spring, joints: []}"), where + ".joints: expected between 1 and 200 joint names, got 0");
    EXPECT_EQ(effect("{joints: [j1]}"), where + ".effect: missing, expected the name of an effect");
    EXPECT_EQ(effect("[spring]"),
              where + ": expected the name of an effect or a map {effect, joints, from, shape}, got a list");
    EXPECT_EQ(effect("{effect: coupling, joints: [j1, j2], from: [j2]}"),
              where + ".from: expected 2 joint names, one for each of `joints`, got 1");
    EXPECT_EQ(effect("{effect: coupling, joints: [j1], from: [j1]}"),
              where + ".from: joint \"j1\" is driven by itself, expected another joint");
    EXPECT_EQ(effect("{effect: spring, shape: {k: x}}"), where + ".shape.k: expected a number, got \"x\"");
    EXPECT_EQ(
        error_of_robot(two_joints("  - {name: tool, type: fixed}\neffects:\n  - {effect: spring, joints: [tool]}\n")),
        "robot.yaml:7: effects[1].joints[1]: joint \"tool\" is fixed, expected one that moves");
    EXPECT_EQ(error_of_robot(two_joints("effects: spring\n")),
              "robot.yaml:5: effects: expected a list of effects such as [viscous_friction], got \"spring\"");
    std::string many = "effects:\n";
    for (int k = 0; k <= 1000; ++k) {
        many += "  - e" + std::to_string(k) + "\n";
    }
    EXPECT_EQ(error_of_robot(two_joints(many)), "robot.yaml:6: effects: expected at most 1000 effects, got 1001");
}

TEST(RobotDescription, AnEffectActsOnceOnAJoint) {
    EXPECT_EQ(error_of_robot(two_joints("effects:\n  - spring\n  - {effect: spring, joints: [j2]}\n")),
              "robot.yaml:7: effects[2]: effect \"spring\" is already on joint \"j2\", line 6");
    EXPECT_EQ(error_of_robot(two_joints("effects:\n  - {effect: spring, joints: [j2, j2]}\n")),
              "robot.yaml:6: effects[1]: effect \"spring\" is already on joint \"j2\", line 6");
    EXPECT_EQ(error_of_robot(
                  two_joints("effects:\n  - {effect: spring, joints: [j1]}\n  - {effect: spring, joints: [j2]}\n")),
              "no error");
}

TEST(RobotDescription, ControlHasOneNumberPerMovingJoint) {
    const auto control = [](const std::string& text) { return error_of_robot(two_joints("control: " + text + "\n")); };
    EXPECT_EQ(control("{law: pd, kp: [1, 2, 3]}"),
              "robot.yaml:5: control.kp: expected one number or a list of 2, one for each joint that moves, got 3");
    EXPECT_EQ(control("{law: pd, kp: [1, x]}"), "robot.yaml:5: control.kp[2]: expected a number, got \"x\"");
    EXPECT_EQ(control("{rate: 100}"), "robot.yaml:5: control.law: missing, expected the name of a control law");
    EXPECT_EQ(control("{law: pd, rate: -1}"), "robot.yaml:5: control.rate: expected a positive number, got \"-1\"");
    EXPECT_EQ(control("{law: pd, delay: -1}"),
              "robot.yaml:5: control.delay: expected a number of seconds, zero or more, got \"-1\"");
    EXPECT_EQ(control("pd"),
              "robot.yaml:5: control: expected a map such as {law: pd_cascade, rate: 200, kp: 10, kv: 1}, got \"pd\"");
}

TEST(RobotDescription, ParametersAreNumbers) {
    EXPECT_EQ(error_of_robot(two_joints("parameters: {ZZ1: one}\n")),
              "robot.yaml:5: parameters.ZZ1: expected a number, got \"one\"");
    EXPECT_EQ(error_of_robot(two_joints("parameters: {ZZ1: 1.5.2}\n")),
              "robot.yaml:5: parameters.ZZ1: expected a number, got \"1.5.2\"");
    EXPECT_EQ(error_of_robot(two_joints("parameters: {ZZ1: +1.5e-2, M1: -.5}\n")), "no error");
}

TEST(RobotDescription, FilesThatAreNoDescriptionAreRefused) {
    EXPECT_EQ(error_of_robot(""), "robot.yaml: is empty");
    EXPECT_EQ(error_of_robot("# only a comment\n"), "robot.yaml: is empty");
    EXPECT_EQ(error_of_robot("- a\n- b\n"),
              "robot.yaml:1: expected a map with keys among name, gravity, constants, joints, loops, effects, control, "
              "parameters, urdf, got a list");
    EXPECT_EQ(error_of_robot("name: arm\njoints: [{theta: q}\nx: 1\n"),
              "robot.yaml:3: not YAML: end of sequence flow not found");
    EXPECT_EQ(error_of_robot(two_joints("---\nname: b\n")),
              "robot.yaml:6: a second YAML document, expected one per file");
    EXPECT_EQ(error_of_robot("name: arm\nx: \x04\n"), "robot.yaml:2: control character \"\\x04\", expected text");
    EXPECT_EQ(error_of_robot("name: arm\nx: " + std::string(1'000'000, 'a')), "robot.yaml: is larger than 1 MB");
    EXPECT_EQ(error_of_robot("joints: [{theta: q}]\n"), "robot.yaml:1: name: missing, expected the name of the robot");
}

TEST(RobotDescription, NestingAndAliasesAreBounded) {
    EXPECT_EQ(error_of_robot("name: arm\nx: " + std::string(20, '[') + std::string(20, ']') + "\n"),
              "robot.yaml:2: lists and maps nested more than 20 levels deep");
    EXPECT_EQ(error_of_robot("name: arm\nx: " + std::string(500'000, '[') + "\n"),
              "robot.yaml:2: lists and maps nested more than 20 levels deep");
    EXPECT_EQ(error_of_robot("name: &n arm\nx: [*n, *n]\n"),
              "robot.yaml:2: YAML aliases (*name) are not read, write the value itself");
}

TEST(RobotDescription, FilesThatCannotBeReadAreRefused) {
    const test::temporary_folder folder;
    const std::string missing = (folder.path() / "none.yaml").string();
    const auto message = [](const std::string& file) -> std::string {
        try {
            read_robot(file);
        } catch (const input_error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message(missing), missing + ": cannot be read: No such file or directory");
    EXPECT_EQ(message(folder.path().string()), folder.path().string() + ": is a folder, expected a file");
}

}  // namespace idim::generator
