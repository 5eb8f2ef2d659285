// The command on logs: what it writes, and what it says of bad ones.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "support/command.hpp"
#include "support/rail_robot.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

/// One mass on a rail: tau = 5 qdd + 2 qd + 0.7 sign(qd) at 200 Hz; `edit` may change the fields of a row.
std::string rail_log(int rows, const std::function<void(int, std::vector<std::string>&)>& edit = {}) {
    std::string text = "t,q1,tau1\n";
    for (int k = 0; k < rows; ++k) {
        const double t = k / 200.0;
        const double qd = std::cos(t) + 1.5 * std::cos(3.0 * t);
        const double qdd = -std::sin(t) - 4.5 * std::sin(3.0 * t);
        const double tau = 5.0 * qdd + 2.0 * qd + 0.7 * (qd > 0.0 ? 1.0 : -1.0);
        std::vector<std::string> fields = {
            fmt::format("{:.3f}", t), fmt::format("{}", std::sin(t) + 0.5 * std::sin(3.0 * t)), fmt::format("{}", tau)};
        if (edit) {
            edit(k, fields);
        }
        text += fmt::format("{}\n", fmt::join(fields, ","));
    }
    return text;
}

class IdentifyCommand : public ::testing::Test {
  protected:
    void SetUp() override { robot_ = folder_.write("rail.yaml", rail_text("viscous_friction, coulomb_friction")); }
    /// The one line of a refused log; no result is left behind.
    std::string refusal(const std::string& log, int status = 2) {
        const std::string file = folder_.write("log.csv", log);
        const std::string result = (folder_.path() / "refused.json").string();
        const command_result answer = run_idim({"identify", robot_, file, "--json", result});
        EXPECT_EQ(answer.status, status) << answer.err;
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        EXPECT_TRUE(status != 2 || !std::filesystem::exists(result));
        std::string line = answer.err;
        if (const std::size_t at = line.find(folder_.path().string()); at != std::string::npos) {
            line.erase(at, folder_.path().string().size() + 1);
        }
        return line;
    }

    temporary_folder folder_;
    std::string robot_;
};

TEST_F(IdentifyCommand, FindsTheParametersOfAnExactLogAndWritesThemAsTheContractSays) {
    const std::string file = folder_.write("log.csv", rail_log(8000));
    const std::string output = (folder_.path() / "result.json").string();
    const command_result answer = run_idim({"identify", robot_, file, "--method", "ols", "--json", output});
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json result = json::parse(read_text(output));
    for (const char* key : {"idim_version", "robot", "method", "converged", "iterations", "samples", "condition_number",
                            "parameters", "residual"}) {
        EXPECT_TRUE(result.contains(key)) << key;
    }
    EXPECT_EQ(result["robot"], "rail");
    EXPECT_EQ(result["method"], "ols");
    EXPECT_EQ(result["parameters"][0]["name"], "M1");
    EXPECT_EQ(result["parameters"][0]["unit"], "kg");
    EXPECT_EQ(result["parameters"][1]["unit"], "N*s/m");
    // The log is exact; what remains is the filter's error at the jumps of sign(qd), which the rows see too.
    EXPECT_NEAR(result["parameters"][0]["value"].get<double>(), 5.0, 0.01);
    EXPECT_NEAR(result["parameters"][1]["value"].get<double>(), 2.0, 0.01);
    EXPECT_NEAR(result["parameters"][2]["value"].get<double>(), 0.7, 0.01);
    EXPECT_EQ(result["residual"]["joints"][0]["joint"], "slide");
}

TEST_F(IdentifyCommand, NamesFileLineAndColumnOfABadNumber) {
    const auto put = [](int row, std::size_t column, const char* text) {
        return [=](int k, std::vector<std::string>& fields) {
            if (k == row) {
                fields[column] = text;
            }
        };
    };
    EXPECT_NE(refusal(rail_log(2000, put(40, 1, "nan"))).find("log.csv:42: q1: "), std::string::npos);
    EXPECT_NE(refusal(rail_log(2000, put(41, 2, "fast"))).find("log.csv:43: tau1: "), std::string::npos);
    EXPECT_NE(refusal(rail_log(2000, put(10, 0, "0.01"))).find("log.csv:12: t: "), std::string::npos);
    EXPECT_NE(refusal(rail_log(2000, [](int k, auto& fields) { fields.resize(k == 7 ? 2 : 3); })).find("log.csv:9: "),
              std::string::npos);
}

TEST_F(IdentifyCommand, SaysWhatALogLacks) {
    EXPECT_NE(refusal("t,q1\n0,1\n0.1,2\n").find("tau1"), std::string::npos);
    EXPECT_NE(refusal("").find("log.csv"), std::string::npos);
    const std::string brief = refusal(rail_log(12));
    EXPECT_NE(brief.find("12"), std::string::npos) << brief;  // the log's own length is named
}

TEST_F(IdentifyCommand, AJointThatNeverMovesIsNamedWithTheParametersThatItLeavesUnexcited) {
    const std::string line = refusal(rail_log(2000, [](int, auto& fields) { fields[1] = "0.25"; }), 3);
    EXPECT_NE(line.find("M1 Fv1 Fc1"), std::string::npos) << line;
    EXPECT_NE(line.find("joint slide never moves"), std::string::npos) << line;
}

TEST_F(IdentifyCommand, AnotherRobotsParametersAreRefused) {
    const std::string file = folder_.write("log.csv", rail_log(2000));
    const std::string parameters = folder_.write("other.yaml", "M1: 1\nFv1: 2\nFc1: 3\noff1: 4\n");
    const command_result answer = run_idim({"validate", robot_, parameters, file});
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("other.yaml: off1: no base parameter of rail"), std::string::npos) << answer.err;
}

TEST_F(IdentifyCommand, UnknownOptionsAndMethodsAreBadUsage) {
    EXPECT_EQ(run_idim({"identify", robot_, "x.csv", "--method", "magic"}).status, 2);
    EXPECT_EQ(run_idim({"identify", robot_, "x.csv", "--wrong"}).status, 2);
    EXPECT_EQ(run_idim({"divine", robot_}).status, 2);
    EXPECT_EQ(run_idim({}).status, 2);
    EXPECT_EQ(run_idim({"--version"}).status, 0);
}

}  // namespace

}  // namespace idim::test
