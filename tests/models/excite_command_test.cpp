// idim excite: references that simulate reads, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/command.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

class ExciteCommand : public ::testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    json result(const std::string& name) const { return json::parse(read_text(file(name))); }
    /// The one line of a refused call; no reference is left behind.
    std::string refusal(const std::string& robot, std::vector<std::string> options) {
        std::vector<std::string> arguments = {
            "excite", robot, "-o", file("refused.csv"), "--json", file("refused.json")};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const command_result answer = run_idim(arguments);
        EXPECT_EQ(answer.status, 2) << answer.err;
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        EXPECT_FALSE(std::filesystem::exists(file("refused.csv")));
        EXPECT_FALSE(std::filesystem::exists(file("refused.json")));
        return answer.err;
    }

    temporary_folder folder_;
};

TEST_F(ExciteCommand, ReproducesTheNumbersOfThePublishedExperiment) {
    const command_result answer =
        run_idim({"excite", robot_file("denso_vp6242g"), "-o", file("ref.csv"), "--form", "multisine", "--period",
                  "380", "--periods", "12", "--rate", "5", "--json", file("excite.json")});
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json found = result("excite.json");
    EXPECT_EQ(found["duration"], 4578.0);
    const double published[] = {.1989, .2981, 1.0715, .2075, .3627, .2025};
    for (std::size_t j = 0; j < 6; ++j) {
        EXPECT_EQ(found["joints"][j]["sinusoids"].size(), 55U);
        EXPECT_NEAR(found["joints"][j]["limit_frequency"].get<double>(), published[j], 1e-4);  // printed digits
    }
    const std::string text = read_text(file("ref.csv"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4578 * 5 + 2);
    EXPECT_EQ(text.rfind("t,qr1,qr2,qr3,qr4,qr5,qr6\n", 0), 0U);
}

/// excite -> simulate -> identify: the parameters that were simulated come back.
TEST_F(ExciteCommand, WhatItWritesIdentifiesASimulatedRobot) {
    const std::string robot = folder_.write(
        "rx90.yaml", read_text(robot_file("rx90")) + "control: {law: computed_torque, rate: 500, wn: 20, zeta: 1}\n");
    const command_result excited =
        run_idim({"excite", robot, "-o", file("ref.csv"), "--position", "-2:2", "--velocity", "3", "--starts", "1",
                  "--evaluations", "30", "--periods", "1", "--time-limit", "1000", "--json", file("excite.json")});
    ASSERT_EQ(excited.status, 0) << excited.err;
    json truth = json::object();
    const json reported = result("excite.json");
    for (const json& parameter : reported["parameters"]) {
        const auto name = parameter["name"].get<std::string>();
        // Inertias of a robot that could be; others are small.
        truth[name] = name[0] == 'F' ? 1.0 : name.rfind("ZZ", 0) == 0 || name.rfind("Ia", 0) == 0 ? 2.0 : 0.01;
    }
    const std::string parameters = folder_.write("truth.json", truth.dump());
    const command_result simulated = run_idim({"simulate", robot, "--parameters", parameters, "--reference",
                                               file("ref.csv"), "-o", file("log.csv"), "--torque-noise", "0.01"});
    ASSERT_EQ(simulated.status, 0) << simulated.err;
    const command_result identified =
        run_idim({"identify", robot, file("log.csv"), "--method", "wls", "--json", file("fit.json")});
    ASSERT_EQ(identified.status, 0) << identified.err;
    const json fit = result("fit.json");
    ASSERT_EQ(fit["parameters"].size(), truth.size());
    for (const json& parameter : fit["parameters"]) {
        // Filtered jumps of friction leave errors of that size (README, "What it rests on").
        EXPECT_NEAR(parameter["value"].get<double>(), truth[parameter["name"].get<std::string>()].get<double>(), 0.05)
            << parameter["name"];
    }
}

TEST_F(ExciteCommand, RefusesWhatNoMotionSatisfiesInOneLine) {
    const std::string denso = robot_file("denso_vp6242g");
    EXPECT_NE(refusal(robot_file("rx90"), {})
                  .find("rx90.yaml:4: limits.position: missing for joint j1, expected two "
                        "numbers here or --position j1=LOW:HIGH"),
              std::string::npos);
    EXPECT_NE(refusal(denso, {"--velocity", "j9=1"}).find("--velocity: \"j9=1\", expected one joint of: j1, j2"),
              std::string::npos);
    EXPECT_NE(refusal(denso, {"--velocity", "0"}).find("--velocity: \"0\", expected"), std::string::npos);
    EXPECT_NE(refusal(denso, {"--position", "j2=1:1"}).find("the lower first"), std::string::npos);
    EXPECT_NE(refusal(denso, {"--torque", "3"}).find("--torque: needs parameters"), std::string::npos);
    EXPECT_NE(refusal(denso, {"--rate", "100", "--period", "20.001"}).find("--period: 20.001 s, expected a whole"),
              std::string::npos);
    EXPECT_NE(refusal(denso, {"--form", "multisine", "--period", "4"}).find("--period: 4 s, expected at least 5.0"),
              std::string::npos);
}

TEST_F(ExciteCommand, RefusesBoxesThatAreNeverReached) {
    const std::string denso = robot_file("denso_vp6242g");
    const std::string far = folder_.write("far.yaml", "- {link: j6, box: [[2, 3], [-1, 1], [-1, 1]]}\n");
    const std::string line = refusal(denso, {"--workspace", far});
    EXPECT_NE(line.find("far.yaml:1: box of j6: no position keeps this limit"), std::string::npos) << line;
    const std::string unknown =
        folder_.write("unknown.yaml", "- {link: j6, box: [[0, 3], [-1, 1], [-1, 1]]}\n- {link: hand, box: []}\n");
    EXPECT_NE(refusal(denso, {"--workspace", unknown}).find("unknown.yaml:2: link: expected one of: j1, j2"),
              std::string::npos);
    const std::string flat = folder_.write("flat.yaml", "- link: j6\n  box: [[0, 3], [1, 1], [-1, 1]]\n");
    EXPECT_NE(refusal(denso, {"--workspace", flat}).find("flat.yaml:2: box: expected [[low, high]"), std::string::npos);
}

TEST_F(ExciteCommand, AnInterruptLeavesTheBestSoFar) {
    const std::string robot = folder_.write("rail.yaml",
                                            "name: rail\ngravity: [0, 0, 0]\njoints:\n"
                                            "  - {name: slide, type: prismatic, r: q, limits: {position: [-1, 1], "
                                            "velocity: 1}}\n"
                                            "effects: [viscous_friction, coulomb_friction]\n");
    ASSERT_EQ(run_idim({"excite", robot, "-o", file("first.csv"), "--starts", "1", "--evaluations", "3"}).status, 0);
    const command_result answer =
        run_program({"timeout", "--signal=INT", "--preserve-status", "10", IDIM_COMMAND, "excite", robot, "-o",
                     file("ref.csv"), "--starts", "100000", "--time-limit", "100000", "--json", file("excite.json")});
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_TRUE(result("excite.json")["interrupted"].get<bool>());
    EXPECT_NE(answer.err.find("condition number"), std::string::npos) << answer.err;
    EXPECT_TRUE(std::filesystem::exists(file("ref.csv")));
}

}  // namespace

}  // namespace idim::test
