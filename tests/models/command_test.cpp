// What the command says of descriptions that cannot be right: one line that names file, line and field, exit status 2,
// and nothing written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ostream>

#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

struct bad_robot {
    const char* name;     ///< of the test
    std::string text;     ///< of the description
    const char* message;  ///< behind the file name
};

std::ostream& operator<<(std::ostream& stream, const bad_robot& robot) {
    return stream << robot.name;
}

class BadRobot : public testing::TestWithParam<bad_robot> {};

/// A five-bar but for its loop, which starts on line 8.
const std::string bars =
    "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, d: 0.2, theta: q}\n"
    "  - {name: j3, antecedent: j1, d: 0.1, theta: q}\n  - {name: j4, antecedent: j2, d: 0.1, theta: q}\nloops:\n";
const std::string cut = "  - cut: [{link: j3, point: [0.3, 0, 0]}, {link: j4, point: [0.3, 0, 0]}]\n";
const std::string passive = "    passive: [j3, j4]\n";
const std::string assembly = "    assembly: 1\n";

const bad_robot bad_robots[] = {
    {"UnknownJointType", "name: a\njoints:\n  - {name: j1, type: spherical, theta: q}\n",
     ":3: joints[1].type: expected revolute, prismatic or fixed"},
    {"CyclicAntecedents",
     "name: a\njoints:\n  - {name: j1, theta: q, antecedent: j2}\n  - {name: j2, theta: q, antecedent: j1}\n",
     ":3: joints[1].antecedent: antecedents form a cycle"},
    {"OwnAntecedent", "name: a\njoints:\n  - {name: j1, theta: q, antecedent: j1}\n", ":3: joints[1].antecedent: "},
    {"UnknownAntecedent", "name: a\njoints:\n  - {name: j1, theta: q, antecedent: j7}\n", ":3: joints[1].antecedent: "},
    {"UnknownSymbol", "name: a\nconstants: {L: 1}\njoints:\n  - {name: j1, theta: q, d: LL}\n",
     ":4: joints[1].d: expression \"LL\": unknown symbol \"LL\", expected one of: L, pi"},
    {"MalformedExpression", "name: a\njoints:\n  - {name: j1, theta: q +* 2}\n", ":3: joints[1].theta: "},
    {"UnclosedParenthesis", "name: a\njoints:\n  - {name: j1, theta: \"(q + 1\"}\n", ":3: joints[1].theta: "},
    {"JointNameThatInjectsCode", "name: a\njoints:\n  - {name: 'j1\"; int main() { return 0; } //', theta: q}\n",
     ":3: joints[1].name: expected a name of letters, digits and underscores"},
    {"RobotNameThatLeavesItsFolder", "name: ../../a\njoints:\n  - {name: j1, theta: q}\n", ":1: name: expected a name"},
    {"RobotNameThatIsAKeyword", "name: namespace\njoints:\n  - {name: j1, theta: q}\n", ":1: name: "},
    {"ConstantNameThatInjectsCode", "name: a\nconstants: {\"L); system(\": 1}\njoints:\n  - {name: j1, theta: q}\n",
     ":2: constants."},
    {"ExpressionThatInjectsCode", "name: a\njoints:\n  - {name: j1, theta: q, d: \"1; system(0)\"}\n",
     ":3: joints[1].d: "},
    {"ThetaWithoutQ", "name: a\njoints:\n  - {name: j1, theta: 0.3}\n",
     ":3: joints[1].theta: \"0.3\" given, expected a constant times q plus a constant"},
    {"ThetaNotLinearInQ", "name: a\njoints:\n  - {name: j1, theta: q^2}\n", ":3: joints[1].theta: "},
    {"DivisionByZero", "name: a\njoints:\n  - {name: j1, theta: q, d: 1/0}\n", ":3: joints[1].d: "},
    {"HugePower", "name: a\njoints:\n  - {name: j1, theta: q, d: 2^(9^9)}\n", ":3: joints[1].d: "},
    {"NothingMoves", "name: a\njoints:\n  - {name: j1, type: fixed}\n", ":3: joints: "},
    {"UnknownEffect", "name: a\njoints:\n  - {name: j1, theta: q}\neffects: [no_such_effect]\n",
     ":4: effects[1]: no effect \"no_such_effect\""},
    {"UnknownKey", "name: a\ngravitation: 9.81\njoints:\n  - {name: j1, theta: q}\n",
     ":2: unknown key \"gravitation\""},
    {"NoYaml", "name: [a\n", ":"},
    {"LoopThatClosesNowhere",
     bars + "  - cut: [{link: j3, point: [0.9, 0, 0]}, {link: j4, point: [0.3, 0, 0]}]\n" + passive + assembly,
     ":8: loops[1]: the loop closes at none of 2000 positions"},
    {"LoopWithPointsInTwoPlanes",
     bars + "  - cut: [{link: j3, point: [0.3, 0, 0.01]}, {link: j4, point: [0.3, 0, 0]}]\n" + passive + assembly,
     ":8: loops[1].cut: the two points of the cut are 0.01 m apart along the axis of joint j3"},
    {"LoopWithAxesThatAreNotParallel",
     "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, alpha: 0.1, theta: q}\n"
     "  - {name: j3, antecedent: j1, d: 0.1, theta: q}\nloops:\n"
     "  - {cut: [{link: j3, point: [0.3, 0, 0]}, {link: j2, point: [0.3, 0, 0]}], passive: [j3, j2], assembly: 1}\n",
     ":7: loops[1]: the axis of joint j2 is not parallel to that of j3"},
    {"LoopWithoutItsPassiveJoint",
     bars + "  - cut: [{link: j3, point: [0.3, 0, 0]}, {link: j2, point: [0.3, 0, 0]}]\n" + passive + assembly,
     ":9: loops[1].passive: joint j4 is not in the loop"},
    {"LoopThatIsCutWithinALink",
     bars + "  - cut: [{link: j3, point: [0.3, 0, 0]}, {link: j3, point: [0.3, 0, 0]}]\n" + passive + assembly,
     ":8: loops[1].cut: both points lie on one link"},
    {"LoopOfAnUnknownLink",
     bars + "  - cut: [{link: j3, point: [0.3, 0, 0]}, {link: j9, point: [0.3, 0, 0]}]\n" + passive + assembly,
     ":8: loops[1].cut[2].link: expected the name of a joint of this robot, or base, got \"j9\""},
    {"JointThatTwoLoopsDetermine", bars + cut + passive + assembly + cut + passive + assembly,
     ":12: loops[2].passive[1]: joint \"j3\" is passive twice"},
    {"PassiveJointThatTurnsByItsOwnRatio",
     "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, d: 0.2, theta: 2*q}\n"
     "  - {name: j3, antecedent: j1, d: 0.1, theta: q}\nloops:\n"
     "  - {cut: [{link: j3, point: [0.3, 0, 0]}, {link: j2, point: [0.3, 0, 0]}], passive: [j3, j2], assembly: 1}\n",
     ":4: joints[2].theta: \"2*q\" given, expected \"q\""},
    {"LoopWithoutAnActiveJoint",
     "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, d: 0.2, theta: q}\n"
     "  - {name: j5, theta: q, antecedent: base}\nloops:\n"
     "  - {cut: [{link: j1, point: [0.3, 0, 0]}, {link: j2, point: [0.3, 0, 0]}], passive: [j1, j2], assembly: 1}\n",
     ":7: loops[1]: no coordinate moves the loop"},
    {"ParallelogramWithSidesThatDiffer", bars + cut + passive + "    assembly: parallelogram\n",
     ":10: loops[1].assembly: opposite sides of the loop are not equal bars"},
    {"ParallelogramThatIsNotCalledOne",
     "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, d: 0.2, theta: q}\n"
     "  - {name: j3, antecedent: j1, d: 0.1, theta: q}\nloops:\n"
     "  - {cut: [{link: j3, point: [0.2, 0, 0]}, {link: j2, point: [0.1, 0, 0]}], passive: [j3, j2], assembly: 1}\n",
     ":7: loops[1].assembly: opposite sides of the loop are equal, expected parallelogram"},
    {"LoopThatNeedsTheAngleOfAnother",
     "name: a\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, antecedent: base, d: 0.2, theta: q}\n"
     "  - {name: j3, antecedent: j1, d: 0.1, theta: q}\n  - {name: j4, antecedent: j2, d: 0.1, theta: q}\n"
     "  - {name: j5, antecedent: j3, d: 0.1, theta: q}\n  - {name: j6, antecedent: base, d: 0.3, theta: q}\nloops:\n"
     "  - {cut: [{link: j3, point: [0.3, 0, 0]}, {link: j4, point: [0.3, 0, 0]}], passive: [j3, j4], assembly: 1}\n"
     "  - {cut: [{link: j5, point: [0.3, 0, 0]}, {link: j6, point: [0.3, 0, 0]}], passive: [j5, j6], assembly: 1}\n",
     ":11: loops[2]: joint j3 is moved by another loop"},
};

void expect_one_line(const std::string& text) {
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_EQ(text.rfind("idim: ", 0), 0u) << text;
}

TEST_P(BadRobot, IsRefusedInOneLineAndNothingIsWritten) {
    const temporary_folder folder;
    const std::string file = folder.write("robot.yaml", GetParam().text);
    const std::filesystem::path out = folder.path() / "model";
    const command_result result = run_idim({"generate", file, "-o", out.string()});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    expect_one_line(result.err);
    EXPECT_EQ(result.err.rfind("idim: " + file + GetParam().message, 0), 0u) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_P(BadRobot, LeavesAModelThatStandsThereAsItIs) {
    const temporary_folder folder;
    const std::string file = folder.write("robot.yaml", GetParam().text);
    const std::string kept = folder.write("model/regressor.hpp", "kept\n");
    EXPECT_EQ(run_idim({"generate", file, "-o", (folder.path() / "model").string()}).status, 2);
    EXPECT_EQ(read_text(kept), "kept\n");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() / "model"), {}), 1);
}

INSTANTIATE_TEST_SUITE_P(Command, BadRobot, testing::ValuesIn(bad_robots),
                         [](const testing::TestParamInfo<bad_robot>& robot) { return std::string(robot.param.name); });

TEST(Command, MissingFileIsBadInput) {
    const command_result result = run_idim({"base", "/no/such/robot.yaml"});
    EXPECT_EQ(result.status, 2);
    expect_one_line(result.err);
    EXPECT_NE(result.err.find("/no/such/robot.yaml"), std::string::npos);
}

TEST(Command, BadUsageIsBadInput) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"no_such_command"}, {"generate", robot_file("emps")}, {"base"}}) {
        const command_result result = run_idim(arguments);
        EXPECT_EQ(result.status, 2);
        expect_one_line(result.err);
    }
}

TEST(Command, FolderThatCannotBeMadeIsBadInput) {
    const temporary_folder folder;
    const std::string file = folder.write("file", "");
    const command_result result = run_idim({"generate", robot_file("emps"), "-o", file + "/model"});
    EXPECT_EQ(result.status, 2);
    expect_one_line(result.err);
}

TEST(Command, JsonIsWrittenIntoAPipeAndDoesNotReplaceIt) {
    const temporary_folder folder;
    const std::string pipe = (folder.path() / "pipe").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDWR);  // so that the command need not wait for one
    ASSERT_GE(reader, 0);
    EXPECT_EQ(run_idim({"base", robot_file("emps"), "--json", pipe}).status, 0);
    std::string text(1 << 12, '\0');
    const ssize_t size = read(reader, text.data(), text.size());
    close(reader);
    EXPECT_EQ(text.rfind("{\n  \"idim_version\"", 0), 0u);
    EXPECT_GT(size, 0);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Command, RankThatCannotBeProvenFailsWithBothFigures) {
    const temporary_folder folder;
    const std::string file = folder.write("near.yaml",
                                          "name: near\ngravity: [0, 0, 0]\njoints:\n  - {name: j1, theta: q}\n  - "
                                          "{name: j2, alpha: 1e-9, d: 0.5, theta: q}\n");
    const command_result result = run_idim({"generate", file, "-o", (folder.path() / "model").string()});
    EXPECT_EQ(result.status, 1);
    expect_one_line(result.err);
    EXPECT_NE(result.err.find("rank 4 by QR"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("8 in exact arithmetic"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "model"));
}

}  // namespace

}  // namespace idim::test
