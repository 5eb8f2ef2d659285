#include "emit/manifest_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

/// An entry of every kind.
manifest full_manifest() {
    manifest content;
    content.generator = "idim 1.2.3";
    content.robot = "arm";
    content.target = "cpp";
    content.cost = "mcu";
    content.input_hash = "0123456789abcdef";
    content.files = {"regressor.hpp", "model_interface.cpp"};
    content.gravity = {"0", "0", "-9.81"};
    content.constants = {{"L", 0.1}, {"a", -1e-300}};
    content.joints = {{"j1", "revolute", "base", true, {{"theta", "q + pi/2"}}, std::pair(-1.5, 2.5), 3.0, 40.0, 0.25},
                      {"j2", "prismatic", "j1", true, {{"alpha", "-pi/2"}, {"r", "q"}}, {}, {}, {}, {}},
                      {"tool", "fixed", "j2", false, {}, {}, {}, {}, {}}};
    content.loops = {{{{{"tool", {"L", "0", "-0.1"}}, {"base", {"0.45", "0", "0"}}}}, {"j1", "j2"}, "parallelogram"}};
    content.effects = {{"stribeck_friction", {"j1"}, {}, {{"vs", 0.03}}, "Fs*exp(-(qd/vs)^2)*sign(qd)"},
                       {"joint_coupling", {"j1", "j2"}, {"j2", "j1"}, {}, "Iac*qdd_from"}};
    content.operations = {{"regressor", {14, 8, 0, 4}}, {"regroup", {1, 3, 0, 0}}};
    return content;
}

struct bad_manifest {
    const char* name;
    const char* pointer;      ///< to the entry that is replaced
    const char* replacement;  ///< JSON; empty to remove the entry
    const char* message;      ///< behind "folder/manifest.json: "
};

std::ostream& operator<<(std::ostream& stream, const bad_manifest& bad) {
    return stream << bad.name;
}

class BadManifest : public testing::TestWithParam<bad_manifest> {};

const bad_manifest bad_manifests[] = {
    {"OfAnotherFormat", "/format", "1", "format: expected 3"},
    {"WithoutFormat", "/format", "", "format: expected an entry"},
    {"OfAnotherInterface", "/interface", "1", "interface: expected "},
    {"WithoutHash", "/input_hash", "", "input_hash: expected an entry"},
    {"WithANumberForAName", "/robot", "7", "robot: expected a text"},
    {"WithATerminalSequence", "/robot", "\"\\u001b[2J\"", "robot: expected text without control characters"},
    {"WithAKeyThatIsATerminalSequence", "/constants", "{\"\\u0007\": 1}", "constants: expected text without"},
    {"WithFilesInAMap", "/files", "{}", "files: expected a list"},
    {"WithConstantsInAList", "/constants", "[]", "constants: expected a map"},
    {"WithTextForAConstant", "/constants/L", "\"0.1\"", "constants.L: expected a number"},
    {"WithoutOperations", "/operations", "", "operations: expected an entry"},
    {"WithFewerThanNoOperations", "/operations/regressor/mul", "-1", "operations.regressor.mul: expected a count"},
    {"WithHalfAnOperation", "/operations/regressor/mul", "0.5", "operations.regressor.mul: expected a count"},
    {"WithTooManyOperations", "/operations/regressor/mul", "5000000000", "operations.regressor.mul: expected a count"},
    {"WithAJointThatIsNoMap", "/joints/1", "\"j2\"", "joints.2: expected a map"},
    {"WithAnUnknownJointType", "/joints/0/type", "\"screw\"", "joints.1.type: expected revolute, prismatic or fixed"},
    {"WithoutTarget", "/target", "", "target: expected an entry"},
    {"WithoutCost", "/cost", "", "cost: expected an entry"},
    {"WithAJointThatIsHalfDriven", "/joints/0/driven", "0.5", "joints.1.driven: expected true or false"},
    {"WithOneLimit", "/joints/0/position", "[1]", "joints.1.position: expected two numbers"},
    {"WithLimitsTheOtherWayRound", "/joints/0/position", "[1, 0]", "joints.1.position: expected two numbers"},
    {"WithATextAsLimit", "/joints/0/velocity", "\"fast\"", "joints.1.velocity: expected a number"},
    {"WithALoopCutAtOnePoint", "/loops/0/cut", "[]", "loops.1.cut: expected two points"},
    {"WithACutInThePlane", "/loops/0/cut/1/point", "[\"0\", \"0\"]", "loops.1.cut.2.point: expected three"},
    {"WithALoopOfOnePassiveJoint", "/loops/0/passive", "[\"j1\"]", "loops.1.passive: expected two joints"},
    {"WithAnEffectNowhere", "/effects/0/joints", "", "effects.1.joints: expected an entry"},
    {"WithAnEffectFromFewerJoints", "/effects/1/from", "[\"j2\"]", "effects.2.from: expected as many joints"},
};

TEST(ManifestFile, ReadsBackWhatWasWritten) {
    const std::string text = to_json_text(full_manifest());
    const manifest read = read_manifest(text, "manifest.json");
    EXPECT_EQ(to_json_text(read), text);
    EXPECT_EQ(read.constants, full_manifest().constants);
    EXPECT_EQ(read.joints[0].position, std::pair(-1.5, 2.5));
    EXPECT_EQ(read.joints[0].drive_gain, 0.25);
    EXPECT_EQ(read.joints[1].row, full_manifest().joints[1].row);
    EXPECT_EQ(read.joints[1].velocity, std::nullopt);
    EXPECT_EQ(read.loops[0].cut[0].at, full_manifest().loops[0].cut[0].at);
    EXPECT_EQ(read.loops[0].passive, full_manifest().loops[0].passive);
    EXPECT_EQ(read.effects[1].from, (std::vector<std::string>{"j2", "j1"}));
    EXPECT_EQ(read.operations[0].second.functions, 4);
}

TEST(ManifestFile, OneEntryMoreIsOneLineMore) {
    const std::string text = to_json_text(full_manifest());
    manifest more = full_manifest();
    more.joints.insert(more.joints.begin() + 1, {"j1b", "revolute", "j1", false, {}, {}, {}, {}, {}});
    const std::string longer = to_json_text(more);
    const auto lines = [](const std::string& t) { return std::count(t.begin(), t.end(), '\n'); };
    EXPECT_EQ(lines(longer), lines(text) + 1);
    const std::size_t at = longer.find("    {\"name\":\"j1b\"");
    ASSERT_NE(at, std::string::npos);
    EXPECT_EQ(std::string(longer).erase(at, longer.find('\n', at) + 1 - at), text);
}

TEST(ManifestFile, EmptyListsAreJsonToo) {
    const std::string text = to_json_text(manifest{});
    EXPECT_EQ(to_json_text(read_manifest(text, "manifest.json")), text);
}

TEST(ManifestFile, TextThatIsNoJsonIsRefused) {
    for (const char* text : {"", "{", "[]", "7", "{\"format\": 1e999}", "\xff\xfe"}) {
        EXPECT_THROW(read_manifest(text, "manifest.json"), input_error) << text;
    }
    EXPECT_THROW(read_manifest(std::string(1000000, '['), "manifest.json"), input_error);
}

TEST_P(BadManifest, IsRefusedNamingTheEntryAndTheWayOut) {
    auto json = nlohmann::ordered_json::parse(to_json_text(full_manifest()));
    const nlohmann::ordered_json::json_pointer at(GetParam().pointer);
    if (*GetParam().replacement == '\0') {
        json.at(at.parent_pointer()).erase(at.back());
    } else {
        json.at(at) = nlohmann::ordered_json::parse(GetParam().replacement);
    }
    try {
        read_manifest(json.dump(), "folder/manifest.json");
        ADD_FAILURE() << "accepted";
    } catch (const input_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(std::string("folder/manifest.json: ") + GetParam().message, 0), 0u) << message;
        EXPECT_NE(message.find("regenerate the folder"), std::string::npos) << message;
    }
}

INSTANTIATE_TEST_SUITE_P(ManifestFile, BadManifest, testing::ValuesIn(bad_manifests),
                         [](const testing::TestParamInfo<bad_manifest>& bad) { return std::string(bad.param.name); });

}  // namespace

}  // namespace idim::generator
