// From a URDF to a robot description: names, order, labels, parameters, effects, notes.
#include <gtest/gtest.h>

#include "description/robot_description.hpp"
#include "support/temporary_folder.hpp"
#include "support/urdf_text.hpp"

namespace idim::generator {

namespace {

using test::temporary_folder;
using test::urdf_text;

const test::rigid_link unit_body = {1.0, {0.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()};

/// A description whose YAML holds `yaml` behind "urdf: robot.urdf".
robot_description with_yaml(const std::string& urdf, const std::string& yaml) {
    const temporary_folder folder;
    folder.write("parts/robot.urdf", urdf);
    return read_robot(folder.write("robot.yaml", "urdf: parts/robot.urdf\n" + yaml));
}

robot_description bare(const std::string& urdf) {
    const temporary_folder folder;
    return read_robot(folder.write("robot.urdf", urdf));
}

template <class F>
std::string error_of_reading(const F& read) {
    try {
        read();
    } catch (const input_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        const std::size_t file = message.find("robot.");
        return file == std::string::npos ? message : message.substr(file);
    }
    return "no error";
}

std::vector<std::string> names_of(const robot_description& robot) {
    std::vector<std::string> names;
    for (const joint_description& joint : robot.joints) {
        names.push_back(joint.name);
    }
    return names;
}

/// Links l0 (root, massless), l1 .. in a chain of joints j1 ..
urdf_text urdf_chain(int joints, const std::string& type = "continuous") {
    urdf_text urdf("arm");
    urdf.massless_link("l0");
    for (int j = 1; j <= joints; ++j) {
        const std::string number = std::to_string(j);
        urdf.link("l" + number, unit_body);
        urdf.joint("j" + number, type, "l" + std::to_string(j - 1), "l" + number, {{0.1, 0.0, 0.0}, {}},
                   {0.0, 0.0, 1.0}, "<dynamics damping=\"0." + number + "\" friction=\"" + number + "\"/>");
    }
    return urdf;
}

}  // namespace

TEST(UrdfRobot, OfABareFileHasItsNameGravityDownwardAndThreeEffectsAtEveryDrivenJoint) {
    urdf_text urdf = urdf_chain(2);
    urdf.link("l3", unit_body).joint("j3", "continuous", "l2", "l3", {}, {1.0, 0.0, 0.0}, "<mimic joint=\"j1\"/>");
    const robot_description robot = bare(urdf.text());
    EXPECT_EQ(robot.name, "arm");
    EXPECT_EQ(robot.gravity[2].text, "-9.81");
    ASSERT_EQ(robot.effects.size(), 3u);
    EXPECT_EQ(robot.effects[0].effect, "rotor_inertia");
    EXPECT_EQ(robot.effects[1].effect, "viscous_friction");
    EXPECT_EQ(robot.effects[2].effect, "coulomb_friction");
    for (const effect_use& use : robot.effects) {
        EXPECT_EQ(use.joints, (std::vector<int>{0, 1}));
    }
    EXPECT_TRUE(robot.notes.empty());
}

TEST(UrdfRobot, HasNoDrivesAtFloatingAndPlanarJoints) {
    urdf_text urdf("arm");
    urdf.massless_link("world").link("body", unit_body).link("arm", unit_body);
    urdf.joint("free", "floating", "world", "body").joint("shoulder", "continuous", "body", "arm");
    const robot_description robot = bare(urdf.text());
    EXPECT_EQ(names_of(robot), (std::vector<std::string>{"free_x", "free_y", "free_z", "free_yaw", "free_pitch",
                                                         "free_roll", "shoulder"}));
    EXPECT_EQ(robot.effects[0].joints, std::vector<int>{6});
    for (std::size_t j = 0; j < 7; ++j) {
        EXPECT_EQ(robot.joints[j].massless, j < 5);
        EXPECT_EQ(robot.links[j].link, j < 5 ? "" : j == 5 ? "body" : "arm");
    }
}

TEST(UrdfRobot, OfAYamlFileTakesTheRestFromThere) {
    const robot_description robot = with_yaml(
        urdf_chain(2).text(),
        "name: mine\ngravity: [0, 0, 0]\nconstants: {L: 1}\neffects: [{effect: viscous_friction, joints: [j2]}]\n"
        "control: {law: pd_cascade, rate: 100, kp: [1, 2], kv: 3}\nparameters: {M1: 5, Ia9: 2}\n");
    EXPECT_EQ(robot.name, "mine");
    EXPECT_EQ(robot.gravity[2].text, "0");
    ASSERT_EQ(robot.effects.size(), 1u);
    EXPECT_EQ(robot.effects[0].joints, std::vector<int>{1});
    EXPECT_EQ(robot.control->values.at("kp"), (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ(robot.parameters.at("M1"), 5.0);
    EXPECT_EQ(robot.parameters.at("M2"), 1.0);
    EXPECT_EQ(robot.parameters.at("Ia9"), 2.0);
    EXPECT_EQ(robot.parameters.at("Fv2"), 0.2);
    EXPECT_EQ(robot.parameters.count("Fv1"), 0u);  // the effect does not act there
    EXPECT_EQ(robot.parameters.count("Fc2"), 0u);
    EXPECT_EQ(with_yaml(urdf_chain(1).text(), "").name, "arm");
}

TEST(UrdfRobot, KeepsTheOrderOfTheFileUnlessAParentComesLater) {
    urdf_text urdf("arm");
    for (const char* link : {"a", "b", "c", "d", "e"}) {
        urdf.link(link, unit_body);
    }
    urdf.joint("last", "continuous", "c", "d").joint("side", "continuous", "a", "e");
    urdf.joint("middle", "continuous", "b", "c").joint("first", "continuous", "a", "b");
    const robot_description robot =
        with_yaml(urdf.text(), "control: {law: pd_cascade, rate: 100, kp: [4, 2, 3, 1], kv: 1}\n");
    EXPECT_EQ(names_of(robot), (std::vector<std::string>{"side", "first", "middle", "last"}));
    EXPECT_EQ(robot.joints[0].antecedent, -1);
    EXPECT_EQ(robot.joints[3].antecedent, 2);
    // One number per joint in the order of the file goes to that joint.
    EXPECT_EQ(robot.control->values.at("kp"), (std::vector<double>{2.0, 1.0, 3.0, 4.0}));
}

TEST(UrdfRobot, ComposesFixedJointsAwayUnlessTheirLinkHasInertia) {
    urdf_text urdf("arm");
    urdf.link("world", unit_body).link("base", unit_body).link("upper", unit_body).massless_link("flange");
    urdf.link("tool", unit_body).link("finger", unit_body);
    urdf.joint("mount", "fixed", "world", "base").joint("shoulder", "continuous", "base", "upper");
    urdf.joint("flange_joint", "fixed", "upper", "flange").joint("tool_joint", "fixed", "flange", "tool");
    urdf.joint("finger_joint", "prismatic", "tool", "finger");
    const robot_description robot = bare(urdf.text());
    EXPECT_EQ(names_of(robot), (std::vector<std::string>{"shoulder", "tool_joint", "finger_joint"}));
    EXPECT_EQ(robot.joints[1].type, joint_type::fixed);
    EXPECT_EQ(robot.joints[1].antecedent, 0);
    EXPECT_EQ(robot.joints[2].antecedent, 0);
    EXPECT_EQ(robot.parameters.at("M_tool_joint"), 1.0);
    EXPECT_EQ(robot.parameters.at("M2"), 1.0);
    EXPECT_EQ(robot.parameters.size(), 30u);
    EXPECT_EQ(robot.links[1].link, "tool");
}

TEST(UrdfRobot, WritesMimicJointsInTheCoordinateTheyFollow) {
    urdf_text urdf = urdf_chain(1);
    urdf.link("l2", unit_body).link("l3", unit_body);
    urdf.joint("my-finger", "continuous", "l1", "l2", {{}, {0.0, 0.0, 1.5708}}, {0.0, 0.0, 1.0},
               "<mimic joint=\"j1\" multiplier=\"-1\" offset=\"1.5708\"/>");
    urdf.joint("rack", "prismatic", "l1", "l3", {{0.0, 0.0, 0.5}, {}}, {0.0, 0.0, 1.0},
               "<mimic joint=\"my-finger\" multiplier=\"0.02\" offset=\"-0.1\"/>");
    const robot_description robot = bare(urdf.text());
    EXPECT_EQ(names_of(robot), (std::vector<std::string>{"j1", "my_finger", "rack"}));
    EXPECT_EQ(robot.joints[1].theta.text, "-q_j1 + pi/2");
    EXPECT_EQ(robot.joints[2].r.text, "-0.02*q_j1 - 0.06858407346410207");
    EXPECT_EQ(robot.parameters.count("M_my_finger"), 1u);
    EXPECT_EQ(robot.parameters.count("M2"), 0u);
}

TEST(UrdfRobot, KeepsLimits) {
    const robot_description robot = bare(urdf_chain(1, "prismatic").text());
    EXPECT_EQ(robot.joints[0].limits.position, (std::pair{-9.0, 9.0}));
    EXPECT_EQ(robot.joints[0].limits.velocity, 3.0);
    EXPECT_EQ(robot.joints[0].limits.effort, 50.0);
}

TEST(UrdfRobot, MakesIdentifiersOfNamesAndSaysSo) {
    urdf_text urdf("my robot");
    urdf.massless_link("0").link("1", unit_body).link("2", unit_body);
    urdf.joint("1-joint", "continuous", "0", "1").joint("double", "continuous", "1", "2");
    const robot_description robot = bare(urdf.text());
    EXPECT_EQ(robot.name, "my_robot");
    EXPECT_EQ(names_of(robot), (std::vector<std::string>{"j1_joint", "double_"}));
    EXPECT_EQ(robot.notes,
              std::vector<std::string>{"names read as identifiers: \"my robot\" as my_robot; \"1-joint\" as "
                                       "j1_joint; \"double\" as double_"});
}

TEST(UrdfRobot, SaysWhichParametersMasslessEndsLack) {
    urdf_text urdf = urdf_chain(1);
    urdf.massless_link("tip").joint("j2", "continuous", "l1", "tip");
    const robot_description robot = bare(urdf.text());
    EXPECT_TRUE(robot.joints[1].massless);
    EXPECT_EQ(robot.notes,
              std::vector<std::string>{
                  "nothing that joint j2 moves has inertia: no parameters XX2 .. M2, and the inertia matrix "
                  "is singular without a rotor inertia there"});
}

TEST(UrdfRobot, SaysWhichAxesAreNearlyParallel) {
    urdf_text urdf = urdf_chain(1);
    urdf.link("l2", unit_body).joint("j2", "continuous", "l1", "l2", {{}, {0.00012, 0.0, 0.0}});
    EXPECT_EQ(bare(urdf.text()).notes,
              std::vector<std::string>{"the axes of joints j1 and j2 are 0.00012 rad from parallel: more digits of the "
                                       "angles would make them parallel"});
}

TEST(UrdfRobot, RefusesNamesThatCollide) {
    urdf_text urdf = urdf_chain(1);
    urdf.link("l2", unit_body).joint("my-j", "continuous", "l1", "l2");
    urdf.link("l3", unit_body).joint("my.j", "continuous", "l2", "l3");
    EXPECT_EQ(error_of_reading([&] { bare(urdf.text()); }),
              "robot.urdf:36: joint \"my.j\": joints \"my-j\" and \"my.j\" both get the name my_j, expected names that "
              "differ in letters and digits");
    urdf_text parts("arm");
    parts.massless_link("a").link("b", unit_body).link("c", unit_body);
    parts.joint("j_x", "continuous", "b", "c").joint("j", "planar", "a", "b");
    EXPECT_NE(error_of_reading([&] { bare(parts.text()); }).find("joints \"j_x\" and \"j_x\" both get the name j_x"),
              std::string::npos);
}

TEST(UrdfRobot, RefusesNamesWhoseParametersWouldBeAlike) {
    urdf_text urdf = urdf_chain(1);
    urdf.link("l2", unit_body).joint("tool", "fixed", "l1", "l2");
    urdf.link("l3", unit_body).joint("toolR", "fixed", "l1", "l3");
    EXPECT_NE(error_of_reading([&] {
                  bare(urdf.text());
              }).find("the parameters of joints \"tool\" and \"toolR\" would get like names, such as XX_toolR"),
              std::string::npos);
}

TEST(UrdfRobot, RefusesARobotThatDoesNotMove) {
    urdf_text urdf("arm");
    urdf.link("a", unit_body).link("b", unit_body).joint("j", "fixed", "a", "b");
    EXPECT_EQ(error_of_reading([&] { bare(urdf.text()); }),
              "robot.urdf: every joint is fixed, expected one that moves");
}

TEST(UrdfRobot, RefusesMoreJointsThanADescriptionMayHave) {
    EXPECT_NE(
        error_of_reading([] { bare(urdf_chain(201).text()); }).find("more than 200 joints that move or carry inertia"),
        std::string::npos);
}

TEST(UrdfRobot, RefusesJointsBesideAUrdfAndFilesThatAreMissing) {
    EXPECT_EQ(error_of_reading([] { with_yaml(urdf_chain(1).text(), "joints: [{theta: q}]\n"); }),
              "robot.yaml:2: joints: the URDF gives the joints, expected one of joints and urdf");
    const temporary_folder folder;
    const std::string file = folder.write("robot.yaml", "urdf: other.urdf\n");
    EXPECT_EQ(error_of_reading([&] { read_robot(file); }),
              folder.path().string() + "/other.urdf: cannot be read: No such file or directory");
}

}  // namespace idim::generator
