// The command with methods that simulate the closed loop: what it writes, and how it refuses.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "oracles/scara_loop.hpp"
#include "support/command.hpp"
#include "support/robot_files.hpp"
#include "support/shared_data.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

class LoopCommand : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new temporary_folder;
        scara_loop robot;
        robot.position_noise = {1e-5, 1e-5};
        robot.torque_noise = {0.4, 0.08};
        log_ = (folder_->path() / "log.csv").string();
        write_log(log_, robot.record(scara_reference(40.0), 1));
        other_ = (folder_->path() / "other.csv").string();
        write_log(other_, robot.record(scara_reference(30.0), 2));
    }
    static void TearDownTestSuite() { delete folder_; }

    static json result_of(std::vector<std::string> arguments) {
        const std::string file = (folder_->path() / "result.json").string();
        arguments.insert(arguments.end(), {"--json", file});
        const command_result answer = run_idim(arguments);
        EXPECT_EQ(answer.status, 0) << answer.err;
        return answer.status == 0 ? json::parse(read_text(file)) : json();
    }

    static temporary_folder* folder_;
    static std::string log_, other_;
};

temporary_folder* LoopCommand::folder_ = nullptr;
std::string LoopCommand::log_, LoopCommand::other_;

TEST_F(LoopCommand, WritesEveryIterationAndTheTests) {
    const json result = result_of({"identify", robot_file("scara"), log_, "--method", "iv", "--start", "regular"});
    EXPECT_EQ(result["method"], "iv");
    EXPECT_EQ(result["converged"], true);
    EXPECT_TRUE(result["loop"]["assumption"].is_null());
    ASSERT_GE(result["iterations"].size(), 3U);
    const json& last = result["iterations"].back();
    EXPECT_EQ(last["joints"].size(), 2U);
    EXPECT_EQ(last["distance_to_measured"][1]["joint"], "j2");
    // Noise of 1e-5 rad on motions of a radian.
    EXPECT_LT(last["distance_to_measured"][0]["q"].get<double>(), 0.01);
    EXPECT_GT(last["distance_to_reference"][0]["q"].get<double>(), 0.01);
    EXPECT_EQ(result["tests"]["residual"].size(), 2U);
    EXPECT_EQ(result["tests"]["instruments"]["least_squares_bias"].size(), 8U);
    EXPECT_NEAR(result["parameters"][0]["value"].get<double>(), 3.44, 0.05);
}

TEST_F(LoopCommand, SeveralLogsAreIdentifiedTogether) {
    const json one = result_of({"identify", robot_file("scara"), log_, "--method", "iv"});
    const json two = result_of({"identify", robot_file("scara"), log_, other_, "--method", "iv"});
    EXPECT_EQ(two["logs"].size(), 2U);
    EXPECT_GT(two["samples"].get<int>(), one["samples"].get<int>());
    EXPECT_NEAR(two["parameters"][0]["value"].get<double>(), 3.44, 0.05);
}

TEST_F(LoopCommand, ComparesAllMethodsOnOneLog) {
    const json result = result_of({"identify", robot_file("scara"), log_, "--compare"});
    ASSERT_EQ(result["methods"].size(), 8U);
    for (const json& method : result["methods"]) {
        ASSERT_EQ(method["parameters"].size(), 8U) << method["method"] << ": " << method["message"];
        EXPECT_NEAR(method["parameters"][0]["value"].get<double>(), 3.44, 0.05) << method["method"];
    }
}

TEST_F(LoopCommand, SaysWhatItAssumesOfAnUnknownControlLaw) {
    std::string text = read_text(robot_file("scara"));
    text.erase(text.find("control:"));
    const std::string robot = folder_->write("scara.yaml", text);
    folder_->write("direct_drive_rotor.yaml", read_text(source_folder + "/robots/scara/direct_drive_rotor.yaml"));
    const json result = result_of({"identify", robot, log_, "--method", "iv", "--bandwidth", "5"});
    const auto assumption = result["loop"]["assumption"].get<std::string>();
    EXPECT_NE(assumption.find("the control law is unknown"), std::string::npos) << assumption;
    EXPECT_NE(assumption.find("5 Hz"), std::string::npos) << assumption;
    EXPECT_NEAR(result["parameters"][0]["value"].get<double>(), 3.44, 0.05);
}

TEST_F(LoopCommand, SimulatesTheDeclaredLawOfTheMeasuredAxis) {
    const auto file = test_support::shared_data("emps/ident.csv.gz");
    if (!file) {
        GTEST_SKIP() << "emps/ident.csv.gz is not here";
    }
    const std::string start = folder_->write("start.yaml", "{M1: 60, Fv1: 0.01, Fc1: 0.01, off1: 0}");
    const std::vector<double> published = {95.12, 203.24, 20.42, -3.170};
    for (const std::string& from : {std::string("ls"), start}) {
        const json result = result_of({"identify", robot_file("emps"), file->string(), "--method", "iv", "--start",
                                       from, "--cutoff", "100", "--decimation", "10"});
        EXPECT_TRUE(result["loop"]["assumption"].is_null());
        EXPECT_LE(result["iterations"].size() - 1, 3U);
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_NEAR(result["parameters"][k]["value"].get<double>(), published[k], 0.002 * std::abs(published[k]));
        }
    }
}

TEST_F(LoopCommand, RefusesAThirdOfTheBandwidthWithExitThree) {
    const command_result answer = run_idim(
        {"identify", robot_file("scara"), log_, "--method", "iv", "--start", "regular", "--bandwidth-scale", "0.2"});
    EXPECT_EQ(answer.status, 3);
    EXPECT_NE(answer.err.find("higher bandwidth"), std::string::npos) << answer.err;
    EXPECT_EQ(answer.out.find("nan"), std::string::npos) << answer.out;
}

TEST_F(LoopCommand, ValidatesByAPosterioriSimulation) {
    const std::string identified = (folder_->path() / "identified.json").string();
    ASSERT_EQ(run_idim({"identify", robot_file("scara"), log_, "--method", "iv", "--json", identified}).status, 0);
    const json result = result_of({"validate", robot_file("scara"), identified, other_, "--simulate"});
    const json& joints = result["simulation"]["distance_to_measured"];
    ASSERT_EQ(joints.size(), 2U);
    EXPECT_LT(joints[0]["q"].get<double>(), 0.01);
    EXPECT_LT(result["simulation"]["torque"]["relative_error"].get<double>(), 0.05);
}

}  // namespace

}  // namespace idim::test
