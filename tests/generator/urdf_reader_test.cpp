// What a URDF may hold, and what is said of one that cannot be read: one line with its line.
#include "description/urdf/urdf_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ostream>

#include "support/temporary_folder.hpp"

namespace idim::generator {

namespace {

urdf_tree tree_of(const std::string& text) {
    const test::temporary_folder folder;
    return read_urdf(folder.write("robot.urdf", text));
}

/// Without the folder.
std::string error_of_urdf(const std::string& text) {
    const test::temporary_folder folder;
    try {
        read_urdf(folder.write("robot.urdf", text));
    } catch (const input_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message.substr(folder.path().string().size() + 1);
    }
    return "no error";
}

/// Links a, b on line 2; joint j on lines 3 to 5, holding `elements` on line 4; `rest` from line 6 on.
std::string one_urdf_joint(const std::string& elements, const std::string& type = "continuous",
                           const std::string& rest = "") {
    return "<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/>\n<joint name=\"j\" type=\"" + type +
           "\"><parent link=\"a\"/><child link=\"b\"/>\n" + elements + "\n</joint>\n" + rest + "</robot>\n";
}

/// A joint between links of these names, on a line of its own.
std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
    return "<joint name=\"" + name + "\" type=\"continuous\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/>" + more + "</joint>\n";
}

std::string links(const std::string& names) {
    std::string text;
    for (const char name : names) {
        text += fmt::format("<link name=\"{}\"/>", name);
    }
    return text + "\n";
}

/// Link b of line 2, with `inertial` on line 3.
std::string one_link(const std::string& inertial) {
    return "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"b\">\n" + inertial + "\n</link>\n" +
           joint("j", "a", "b") + "</robot>\n";
}

const std::string inertia = "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>";

struct bad_urdf {
    const char* name;
    std::string text;
    std::string message;
};

std::ostream& operator<<(std::ostream& stream, const bad_urdf& urdf) {
    return stream << urdf.name;
}

std::string many_links(int count) {
    std::string text = "<robot name=\"r\">\n";
    for (int i = 0; i < count; ++i) {
        text += "<link name=\"l" + std::to_string(i) + "\"/>\n";
    }
    return text + "</robot>\n";
}

const bad_urdf bad_urdfs[] = {
    {"Empty", "", "robot.urdf: not XML: expected an element such as <robot name=\"...\">"},
    {"MalformedXml", "<robot name=\"r\">\n<link name=\"a\">\n</robot>",
     "robot.urdf:3: not XML: \"</robot>\" does not close"},
    {"NoUrdf", "<sdf/>", "robot.urdf:1: expected a URDF, <robot name=\"...\">, got element \"sdf\""},
    {"UnnamedRobot", "<robot><link name=\"a\"/></robot>", "robot.urdf:1: robot has no name"},
    {"Macros", "<robot name=\"r\">\n<xacro:include filename=\"x\"/></robot>", "robot.urdf:2: macros are not expanded"},
    {"NoLinks", "<robot name=\"r\"/>", "robot.urdf:1: robot has no links, expected <link name=\"...\"/>"},
    {"UnnamedLink", "<robot name=\"r\">\n<link/></robot>", "robot.urdf:2: link has no name"},
    {"UnnamedJoint", "<robot name=\"r\">\n<link name=\"a\"/>\n<joint/></robot>", "robot.urdf:3: joint has no name"},
    {"TwoLinksOfOneName", "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"a\"/></robot>",
     "robot.urdf:3: link \"a\" is already on line 2"},
    {"TwoJointsOfOneName",
     "<robot name=\"r\">\n" + links("abc") + joint("j", "a", "b") + joint("j", "a", "c") + "</robot>",
     "robot.urdf:4: joint \"j\" is already on line 3"},
    {"NoParent",
     "<robot name=\"r\">\n" + links("ab") + "<joint name=\"j\" type=\"fixed\"><child link=\"b\"/></joint></robot>",
     "robot.urdf:3: joint \"j\": has no parent, expected <parent link=\"...\"/>"},
    {"NoChild",
     "<robot name=\"r\">\n" + links("ab") + "<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/></joint></robot>",
     "robot.urdf:3: joint \"j\": has no child, expected <child link=\"...\"/>"},
    {"MissingParentLink", "<robot name=\"r\">\n" + links("ab") + joint("j", "c", "b") + "</robot>",
     "robot.urdf:3: joint \"j\": parent link \"c\" is not in the file"},
    {"MissingChildLink", "<robot name=\"r\">\n" + links("ab") + joint("j", "a", "c") + "</robot>",
     "robot.urdf:3: joint \"j\": child link \"c\" is not in the file"},
    {"TwoRoots", "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\"/></robot>",
     "robot.urdf:3: link \"b\": no joint moves this link nor link \"a\", line 2: expected one root"},
    {"TwoParents",
     "<robot name=\"r\">\n" + links("abc") + joint("i", "a", "b") + joint("j", "a", "c") + joint("k", "b", "c") +
         "</robot>",
     "robot.urdf:5: joint \"k\": link \"c\" is already the child of joint \"j\", line 4: expected a tree"},
    {"Cycle",
     "<robot name=\"r\">\n" + links("abc") + joint("i", "a", "b") + joint("j", "b", "c") + joint("k", "c", "a") +
         "</robot>",
     "robot.urdf:2: link \"a\": links form a cycle: \"a\" -> \"b\" -> \"c\" -> \"a\", expected a tree"},
    {"CycleBesideTheTree",
     "<robot name=\"r\">\n" + links("abcd") + joint("i", "a", "b") + joint("j", "c", "d") + joint("k", "d", "c") +
         "</robot>",
     "robot.urdf:2: link \"c\": links form a cycle: \"c\" -> \"d\" -> \"c\", expected a tree"},
    {"LongCycle",
     "<robot name=\"r\">\n" + links("abcdefgh") + joint("1", "h", "a") + joint("2", "a", "b") + joint("3", "b", "c") +
         joint("4", "c", "d") + joint("5", "d", "e") + joint("6", "e", "f") + joint("7", "f", "g") +
         joint("8", "g", "h") + "</robot>",
     "robot.urdf:2: link \"a\": links form a cycle: \"a\" -> \"b\" -> \"c\" -> \"d\" -> \"e\" -> \"f\" -> ... -> "
     "\"a\", expected"},
    {"OwnParent", "<robot name=\"r\">\n" + links("ab") + joint("j", "b", "b") + "</robot>",
     "robot.urdf:2: link \"b\": links form a cycle: \"b\" -> \"b\", expected a tree"},
    {"UnknownJointType", one_urdf_joint("", "ball"),
     "robot.urdf:3: joint \"j\": not URDF: Joint [j] has no known type [ball]"},
    {"TypeThatIsNoText", one_urdf_joint("", "b\xc3"),
     "robot.urdf:3: joint \"j\": not URDF: Joint [j] has no known type [b?]"},
    {"NoLimits", one_urdf_joint("", "revolute"),
     "robot.urdf:3: joint \"j\": not URDF: Joint [j] is of type REVOLUTE but"},
    {"ZeroAxis", one_urdf_joint("<axis xyz=\"0 0 0\"/>"),
     "robot.urdf:3: joint \"j\": axis is zero, expected a direction"},
    {"AxisOfTwoNumbers", one_urdf_joint("<axis xyz=\"0 1\"/>"), "robot.urdf:3: joint \"j\": not URDF: Malformed axis"},
    {"OriginThatIsNoNumber", one_urdf_joint("<origin xyz=\"0 one 0\"/>"), "robot.urdf:3: joint \"j\": not URDF: "},
    {"OriginThatIsNotFinite", one_urdf_joint("<origin xyz=\"0 nan 0\"/>"), "robot.urdf:3: joint \"j\": not URDF: "},
    {"OriginThatOverflows", one_urdf_joint("<origin xyz=\"0 1e999 0\"/>"), "robot.urdf:3: joint \"j\": not URDF: "},
    {"AngleThatUnderflows", one_urdf_joint("<origin rpy=\"0 1e-999 0\"/>"),
     "robot.urdf:4: joint \"j\": expected a finite angle"},
    {"OriginOutOfThisWorld", one_urdf_joint("<origin xyz=\"0 1e10 0\"/>"),
     "robot.urdf:3: joint \"j\": a number beyond 1e9"},
    {"LimitsThatCross", one_urdf_joint("<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>", "revolute"),
     "robot.urdf:3: joint \"j\": lower limit above the upper one"},
    {"NegativeDamping", one_urdf_joint("<dynamics damping=\"-1\"/>"),
     "robot.urdf:3: joint \"j\": negative damping, expected zero or more"},
    {"NegativeMass", one_link("<inertial><mass value=\"-1\"/>" + inertia + "</inertial>"),
     "robot.urdf:2: link \"b\": negative mass, expected zero or more"},
    {"NoMass", one_link("<inertial>" + inertia + "</inertial>"),
     "robot.urdf:2: link \"b\": not URDF: Inertial element must have a mass"},
    {"MassThatIsNoNumber", one_link("<inertial><mass value=\"x\"/>" + inertia + "</inertial>"),
     "robot.urdf:2: link \"b\": not URDF: "},
    {"InertiaOfFiveNumbers", one_link("<inertial><mass value=\"1\"/><inertia ixx=\"1\"/></inertial>"),
     "robot.urdf:2: link \"b\": not URDF: Inertial: inertia element missing"},
    {"MimicOfNothing", one_urdf_joint("<mimic joint=\"k\"/>"),
     "robot.urdf:3: joint \"j\": mimics joint \"k\", which is not in the file"},
    {"MimicOfItself", one_urdf_joint("<mimic joint=\"j\"/>"),
     "robot.urdf:3: joint \"j\": joints mimic each other: \"j\" -> \"j\""},
    {"MimicCycle",
     "<robot name=\"r\">\n" + links("abcd") + joint("i", "a", "b", "<mimic joint=\"j\"/>") +
         joint("j", "b", "c", "<mimic joint=\"k\"/>") + joint("k", "c", "d", "<mimic joint=\"j\"/>") + "</robot>",
     "robot.urdf:4: joint \"j\": joints mimic each other: \"j\" -> \"k\" -> \"j\", expected one that is driven"},
    {"MimicOfAFixedJoint",
     one_urdf_joint(
         "<mimic joint=\"k\"/>", "continuous",
         "<link name=\"c\"/><joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/></joint>\n"),
     "robot.urdf:3: joint \"j\": mimics joint \"k\", expected a revolute, continuous or prismatic joint"},
    {"FixedJointThatMimics", one_urdf_joint("<mimic joint=\"j\"/>", "fixed"),
     "robot.urdf:3: joint \"j\": mimics another joint, expected"},
    {"MimicThatStands", one_urdf_joint("<mimic joint=\"j\" multiplier=\"0\"/>"),
     "robot.urdf:3: joint \"j\": mimics with multiplier 0"},
    {"Entities", "<!DOCTYPE r [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<robot name=\"&b;\"/>",
     "robot.urdf:1: document types and entities are not read, expected elements only"},
    {"ManyLinks", many_links(100'000), "robot.urdf:2002: more than 2000 elements \"link\""},
    {"LargeFile", "<robot name=\"r\">" + std::string(16'000'000, ' ') + "</robot>", "robot.urdf: is larger than 16 MB"},
    {"ManyElements",
     "<robot name=\"r\">" +
         [] {
             std::string text;
             for (int i = 0; i < 100'000; ++i) {
                 text += "<x/>";
             }
             return text;
         }() +
         "</robot>",
     "robot.urdf:1: more than 100000 elements"},
    {"DeepNesting",
     [] {
         std::string text;
         for (int i = 0; i < 1'000'000; ++i) {
             text += "<robot>";
         }
         return text;
     }(),
     "robot.urdf:1: elements nested more than 32 deep"},
    {"ManyAttributes",
     [] {
         std::string text = "<robot";
         for (int i = 0; i < 100'000; ++i) {
             text += " a" + std::to_string(i) + "=''";
         }
         return text + "/>";
     }(),
     "robot.urdf:1: element \"robot\" has more than 64 attributes"},
    {"ControlCharacters", std::string("<robot name=\"r\">\n\x01</robot>"), "robot.urdf:2: control character"},
};

class BadUrdf : public testing::TestWithParam<bad_urdf> {};

TEST_P(BadUrdf, IsRefusedInOneLineThatNamesThePlace) {
    testing::internal::CaptureStderr();
    const std::string error = error_of_urdf(GetParam().text);
    EXPECT_EQ(error.rfind(GetParam().message, 0), 0u) << error;
    EXPECT_LT(error.size(), 400u);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // what urdfdom prints of itself
}

INSTANTIATE_TEST_SUITE_P(UrdfReader, BadUrdf, testing::ValuesIn(bad_urdfs),
                         [](const testing::TestParamInfo<bad_urdf>& urdf) { return std::string(urdf.param.name); });

TEST(UrdfReader, ReadsLinksAndJointsInTheOrderOfTheFile) {
    const urdf_tree tree = tree_of(
        "<robot name=\"arm\">\n<link name=\"z\"/>\n<joint name=\"j2\" type=\"prismatic\">\n"
        "<parent link=\"z\"/><child link=\"a\"/><origin xyz=\"1 2 3\" rpy=\"0.1\t0.2\n-3.14159\"/><axis xyz=\"0 -2 "
        "0\"/>\n"
        "<limit lower=\"-0.5\" upper=\"1\" effort=\"20\" velocity=\"3\"/><dynamics damping=\"0.5\" "
        "friction=\"0.25\"/>\n"
        "</joint>\n<link name=\"a\"><inertial><origin xyz=\"4 5 6\" rpy=\"0 1.5708 0\"/><mass value=\"7\"/>\n"
        "<inertia ixx=\"1\" ixy=\"2\" ixz=\"3\" iyy=\"4\" iyz=\"5\" izz=\"6\"/></inertial></link>\n</robot>\n");
    EXPECT_EQ(tree.name, "arm");
    ASSERT_EQ(tree.links.size(), 2u);
    EXPECT_EQ(tree.links[0].name, "z");
    EXPECT_EQ(tree.root, 0);
    const urdf_inertial& inertial = tree.links[1].inertial.value();
    EXPECT_EQ(inertial.mass, 7.0);
    EXPECT_EQ(inertial.xyz, (std::array<double, 3>{4.0, 5.0, 6.0}));
    EXPECT_EQ(inertial.rpy, (std::array<double, 3>{0.0, 1.5707963267948966, 0.0}));
    EXPECT_EQ(inertial.inertia, (std::array<double, 6>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
    ASSERT_EQ(tree.joints.size(), 1u);
    const urdf_joint& joint = tree.joints[0];
    EXPECT_EQ(joint.type, urdf_joint_type::prismatic);
    EXPECT_EQ(joint.where.line, 3);
    EXPECT_EQ(joint.xyz, (std::array<double, 3>{1.0, 2.0, 3.0}));
    EXPECT_EQ(joint.rpy, (std::array<double, 3>{0.1, 0.2, -3.141592653589793}));
    EXPECT_EQ(joint.axis, (std::array<double, 3>{0.0, -2.0, 0.0}));
    EXPECT_EQ(joint.limits.position, (std::pair{-0.5, 1.0}));
    EXPECT_EQ(joint.limits.effort, 20.0);
    EXPECT_EQ(joint.limits.velocity, 3.0);
    EXPECT_EQ(joint.damping, 0.5);
    EXPECT_EQ(joint.friction, 0.25);
}

TEST(UrdfReader, SaysWhichAnglesBecameMultiplesOfPiAndWhichNearlyDid) {
    const urdf_tree tree = tree_of(
        one_urdf_joint("<origin rpy=\"1.5708 1.5708 -3.1415\"/>", "continuous",
                       "<link name=\"c\"/>\n<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/>\n"
                       "<origin rpy=\"1.5708 1.57 1.5707963267948966\"/></joint>\n"));
    EXPECT_EQ(tree.notes,
              (std::vector<std::string>{
                  "angles read as multiples of pi/2: 1.5708 as pi/2 (lines 4, 8); -3.1415 as -pi (line 4)",
                  "angles with too few decimals to be a multiple of pi/2, read as written: 1.57 (line 8)"}));
}

TEST(UrdfReader, PassesOverWhatNeitherMovesNorHasInertia) {
    const urdf_tree tree = tree_of(
        "<robot name=\"r\">\n<material name=\"m\"/><link name=\"a\"><visual><geometry><mesh/></geometry>"
        "<material name=\"none\"/></visual><collision/></link>\n<link name=\"b\"/>\n" +
        joint("j", "a", "b", "<safety_controller/><calibration rising=\"x\"/>") +
        "<transmission name=\"t\"><joint name=\"j\"/></transmission><gazebo><link name=\"c\"/></gazebo></robot>");
    EXPECT_EQ(tree.links.size(), 2u);
    EXPECT_EQ(tree.joints.size(), 1u);
}

TEST(UrdfReader, FollowsChainsOfMimicJointsToTheDrivenOne) {
    const urdf_tree tree = tree_of("<robot name=\"r\">\n" + links("abcd") +
                                   joint("k", "c", "d", "<mimic joint=\"j\" multiplier=\"0.1\" offset=\"0.2\"/>") +
                                   joint("j", "b", "c", "<mimic joint=\"i\" multiplier=\"-3\" offset=\"0.7\"/>") +
                                   joint("i", "a", "b") + "</robot>");
    const urdf_mimic& k = tree.joints[0].mimic.value();
    EXPECT_EQ(k.joint, 2);
    EXPECT_EQ(k.multiplier, -0.3);
    EXPECT_EQ(k.offset, 0.27);
    EXPECT_FALSE(tree.joints[2].mimic);
}

TEST(UrdfReader, LimitsOfZeroAreNone) {
    const urdf_tree tree =
        tree_of(one_urdf_joint("<limit lower=\"0\" upper=\"0\" effort=\"0\" velocity=\"0\"/>", "prismatic"));
    EXPECT_FALSE(tree.joints[0].limits.position);
    EXPECT_FALSE(tree.joints[0].limits.velocity);
    EXPECT_FALSE(tree.joints[0].limits.effort);
}

TEST(UrdfReader, LinksWhoseMassAndInertiaAreZeroHaveNone) {
    const urdf_tree tree =
        tree_of(one_link("<inertial><mass value=\"0\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" "
                         "iyz=\"0\" izz=\"0\"/></inertial>"));
    EXPECT_FALSE(tree.links[1].inertial);
}

}  // namespace

}  // namespace idim::generator
