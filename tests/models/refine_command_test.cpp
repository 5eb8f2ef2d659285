// The closed loop from a log with something undeclared in it: what is found, and what is not. Torques are the closed
// form of the paper's SCARA [IV 53] along sums of sinusoids, with white noise of 2 % of each joint's torque.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "support/command.hpp"
#include "support/sign.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

constexpr double log_rate = 200.0;  // Hz
constexpr double duration = 40.0;   // s

struct instant {
    double t = 0.0;
    std::array<double, 2> q{}, qd{}, qdd{};
};

/// Torque of both joints that the description does not have.
using undeclared = std::function<std::array<double, 2>(const instant&)>;

instant instant_at(double t, int which) {
    constexpr std::array<std::array<double, 4>, 4> frequency = {
        {{0.11, 0.23, 0.53, 0.89}, {0.13, 0.31, 0.61, 1.03}, {0.07, 0.19, 0.43, 0.97}, {0.17, 0.29, 0.67, 0.83}}};
    constexpr std::array<double, 4> amplitude = {0.8, 0.5, 0.25, 0.12};
    instant now;
    now.t = t;
    for (std::size_t j = 0; j < 2; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
            const double w = 2.0 * M_PI * frequency[static_cast<std::size_t>(2 * which) + j][i];
            const double phase = 0.7 * static_cast<double>(i) + static_cast<double>(j) + static_cast<double>(which);
            now.q[j] += amplitude[i] * std::sin(w * t + phase);
            now.qd[j] += amplitude[i] * w * std::cos(w * t + phase);
            now.qdd[j] -= amplitude[i] * w * w * std::sin(w * t + phase);
        }
    }
    return now;
}

/// [IV 53] with L = 0.5 m and the values of its table 1.
std::array<double, 2> scara_torque(const instant& s) {
    constexpr double ZZ1 = 3.44, ZZ2 = 0.062, X = 0.121, Y = 0.007, Fv1 = 0.03, Fc1 = 0.82, Fv2 = 0.013, Fc2 = 0.137;
    const double c = std::cos(s.q[1]);
    const double n = std::sin(s.q[1]);
    const double both = s.qdd[0] + s.qdd[1];
    const double twice = 2.0 * s.qdd[0] + s.qdd[1];
    const double cross = s.qd[1] * (2.0 * s.qd[0] + s.qd[1]);
    return {ZZ1 * s.qdd[0] + ZZ2 * both + X * (twice * c - cross * n) - Y * (twice * n + cross * c) + Fv1 * s.qd[0] +
                Fc1 * sign(s.qd[0]),
            ZZ2 * both + X * (s.qdd[0] * c + s.qd[0] * s.qd[0] * n) + Y * (s.qd[0] * s.qd[0] * c - s.qdd[0] * n) +
                Fv2 * s.qd[1] + Fc2 * sign(s.qd[1])};
}

/// The same arm upright, gravity g turned by `tilt` about its axes: the potential of first moments at q1 and q1 + q2.
std::array<double, 2> gravity_torque(const instant& s, double tilt) {
    constexpr double g = 9.81, A = 2.1, MX2 = 0.242, MY2 = 0.014;  // LMX2, LMY2 of scara_torque over L = 0.5 m
    const double both = s.q[0] + s.q[1] - tilt;
    const double second = g * (MX2 * std::cos(both) - MY2 * std::sin(both));
    return {g * A * std::cos(s.q[0] - tilt) + second, second};
}

std::string log_text(int which, unsigned seed, const undeclared& missing) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::string text = "t,q1,q2,tau1,tau2\n";
    const int samples = static_cast<int>(duration * log_rate);
    for (int k = 0; k < samples; ++k) {
        const instant s = instant_at(k / log_rate, which);
        const std::array<double, 2> torque = scara_torque(s);
        const std::array<double, 2> extra = missing(s);
        text += fmt::format("{},{},{},{},{}\n", s.t, s.q[0] + 1e-6 * normal(random), s.q[1] + 1e-6 * normal(random),
                            torque[0] + extra[0] + 0.3 * normal(random), torque[1] + extra[1] + 0.02 * normal(random));
    }
    return text;
}

class RefineCommand : public ::testing::Test {
  protected:
    json refine(const undeclared& missing, const std::string& gravity = "[0, 0, 0]",
                const std::string& more_effects = "") {
        write_files(missing, gravity, more_effects);
        const command_result answer = run_idim(words_with({"--json", output() + ".json"}));
        EXPECT_EQ(answer.status, 0) << answer.err;
        return json::parse(read_text(output() + ".json"));
    }

    void write_files(const undeclared& missing, const std::string& gravity = "[0, 0, 0]",
                     const std::string& more_effects = "") {
        robot_ = folder_.write("arm.yaml", "name: arm\ngravity: " + gravity +
                                               "   # flat\njoints:\n"
                                               "  - {name: j1, theta: q}\n  - {name: j2, d: 0.5, theta: q}\n"
                                               "effects: [viscous_friction, coulomb_friction" +
                                               more_effects + "]   # both joints\n");
        fitted_ = folder_.write("ident.csv", log_text(0, 1, missing));
        other_ = folder_.write("valid.csv", log_text(1, 2, missing));
    }

    std::vector<std::string> words_with(const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"refine", robot_, fitted_, "--validation", other_, "-o", output()};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    /// What the command leaves in its folder.
    json run(const std::vector<std::string>& more) const {
        const command_result answer = run_idim(words_with(more));
        EXPECT_EQ(answer.status, 0) << answer.err;
        return json::parse(read_text(output() + "/refine.json"));
    }

    std::string output() const { return (folder_.path() / "refined").string(); }

    temporary_folder folder_;
    std::string robot_, fitted_, other_;
};

/// A spring at joint 2 and a ripple at joint 1.
std::array<double, 2> spring_and_ripple(const instant& s) {
    return {0.5 * std::cos(7.0 * s.q[0]), 0.04 * s.q[1] + 0.01};
}

std::set<std::string> effects_of(const json& result) {
    std::set<std::string> names;
    for (const json& step : result["steps"]) {
        names.insert(std::string(step["effect"]) + " " + std::string(step["joints"][0]));
    }
    return names;
}

/// One effect, at the right place, that lowers the error on the log it was not fitted to.
void expect_one(const json& result, const std::string& effect, const json& joints) {
    EXPECT_EQ(result["verdict"], "effects_added");
    ASSERT_EQ(result["steps"].size(), 1U) << result["steps"].dump();
    const json& step = result["steps"][0];
    EXPECT_EQ(step["effect"], effect);
    EXPECT_EQ(step["joints"], joints);
    EXPECT_LT(result["after"]["validation"]["joints"][1]["relative_error"],
              0.9 * double(result["before"]["validation"]["joints"][1]["relative_error"]));
}

/// Within four deviations: one value in 16 000 of a right interval lies outside.
void expect_near(const json& parameter, double truth) {
    EXPECT_NEAR(parameter["value"], truth, 4.0 * double(parameter["std"]));
    EXPECT_LT(double(parameter["std"]), 0.25 * std::abs(truth));
}

TEST_F(RefineCommand, FindsNothingWhereNothingIsMissing) {
    const json result = refine([](const instant&) { return std::array<double, 2>{}; });
    EXPECT_EQ(result["verdict"], "no_missing_effect");
    EXPECT_EQ(result["unexplained"], json::array());
    EXPECT_TRUE(result["steps"].empty());
    EXPECT_EQ(result["before"], result["after"]);
}

TEST_F(RefineCommand, ASpringIsFoundWithItsStiffness) {
    const json result = refine([](const instant& s) { return std::array<double, 2>{0.0, 0.04 * s.q[1] + 0.01}; });
    expect_one(result, "spring", {"j2"});
    expect_near(result["steps"][0]["parameters"]["K"], 0.04);
}

TEST_F(RefineCommand, RippleIsFoundWithItsPeriod) {
    const json result = refine([](const instant& s) {
        return std::array<double, 2>{0.0, 0.03 * std::cos(11.3 * s.q[1]) - 0.01 * std::sin(11.3 * s.q[1])};
    });
    expect_one(result, "torque_ripple", {"j2"});
    EXPECT_NEAR(result["steps"][0]["parameters"]["k"]["value"], 11.3, 0.05 * 11.3);
    expect_near(result["steps"][0]["parameters"]["Ac"], 0.03);
}

TEST_F(RefineCommand, FrictionOfTheOtherJointIsFoundAtThePair) {
    const json result = refine([](const instant& s) { return std::array<double, 2>{0.0, 0.03 * sign(s.qd[0])}; });
    expect_one(result, "coupling_friction", {"j2"});
    EXPECT_EQ(result["steps"][0]["from"], json({"j1"}));
    expect_near(result["steps"][0]["parameters"]["Fcc"], 0.03);
}

// Joint 1 carries sixteen times the torque and fifteen times the noise of joint 2, where alone the coupling shows.
TEST_F(RefineCommand, ACouplingThatShowsAtTheLightJointIsFoundAtThePair) {
    constexpr double viscous = 0.002, coulomb = 0.02;
    const json result = refine(
        [](const instant& s) {
            const double both = coulomb * sign(s.qd[0] + s.qd[1]);
            return std::array<double, 2>{viscous * s.qd[1] + both, viscous * s.qd[0] + both};
        },
        "[0, 0, 0]", ", rotor_inertia");
    expect_one(result, "joint_coupling", {"j1", "j2"});
    const json& parameters = result["steps"][0]["parameters"];
    expect_near(parameters["Fcc"], coulomb);
    // With the rotors' inertias it is ZZ2 less both of them, and has no value of its own.
    EXPECT_EQ(parameters["Iac"]["value"], nullptr);
    EXPECT_EQ(parameters["Iac"]["std"], nullptr);
}

TEST_F(RefineCommand, ATiltedBaseIsFoundWithItsAngle) {
    const json result = refine([](const instant& s) { return gravity_torque(s, 0.04); }, "[0, -9.81, 0]");
    ASSERT_EQ(result["steps"].size(), 1U) << result["steps"].dump();
    EXPECT_EQ(result["steps"][0]["effect"], "base_tilt");
    expect_near(result["steps"][0]["parameters"]["tilt_z"], 0.04);
    EXPECT_LT(result["after"]["validation"]["relative_error"], result["before"]["validation"]["relative_error"]);
    EXPECT_NE(read_text(output() + "/robot.yaml").find("{effect: base_tilt, shape: {tilt_"), std::string::npos);
}

TEST_F(RefineCommand, WhatTheModelTakesUpIsListedWithItsReason) {
    const json result = refine([](const instant& s) { return gravity_torque(s, 0.0); }, "[0, -9.81, 0]");
    EXPECT_TRUE(result["steps"].empty()) << result["steps"].dump();
    std::string hidden;
    for (const json& entry : result["not_identifiable"]) {
        hidden += std::string(entry["effect"]) + " " + std::string(entry["joints"][0]) + ": " +
                  std::string(entry["reason"]) + "\n";
    }
    const std::size_t start = hidden.find("gravity_compensator j1: taken up by ");
    ASSERT_NE(start, std::string::npos) << hidden;
    const std::string line = hidden.substr(start, hidden.find('\n', start) - start);
    EXPECT_NE(line.find("MX1R"), std::string::npos) << line;  // cos(q1) and sin(q1)
    EXPECT_NE(line.find("MY1"), std::string::npos) << line;
    EXPECT_NE(hidden.find("payload j2: a load that never comes off"), std::string::npos) << hidden;
    EXPECT_EQ(hidden.find("spring"), std::string::npos) << hidden;
}

TEST_F(RefineCommand, DeclaredTermsThatTheDataDoesNotSupportAreNamed) {
    const json result = refine([](const instant&) { return std::array<double, 2>{}; }, "[0, 0, 0]", ", torque_offset");
    std::string named;
    for (const json& term : result["unsupported"]) {
        named += std::string(term["effect"]) + " " + std::string(term["joints"][0]) + "\n";
        EXPECT_GT(term["p_value"], 0.05);
        // Left out, it costs no more than its own noise: one coefficient of thousands of rows.
        EXPECT_NEAR(term["without"]["validation"]["relative_error"], result["after"]["validation"]["relative_error"],
                    0.01 * double(result["after"]["validation"]["relative_error"]));
    }
    EXPECT_NE(named.find("torque_offset j1"), std::string::npos) << named;
    EXPECT_NE(named.find("torque_offset j2"), std::string::npos) << named;
    EXPECT_EQ(named.find("coulomb_friction"), std::string::npos) << named;
}

TEST_F(RefineCommand, LeavesADescriptionAndCodeThatReproduceTheResult) {
    const json result = refine([](const instant& s) { return std::array<double, 2>{0.0, 0.04 * s.q[1]}; });
    const std::string description = read_text(output() + "/robot.yaml");
    EXPECT_NE(description.find("gravity: [0, 0, 0]   # flat\n"), std::string::npos) << description;
    EXPECT_NE(description.find("{effect: spring, joints: [j2]}"), std::string::npos) << description;
    const command_result current =
        run_idim({"generate", output() + "/robot.yaml", "-o", output() + "/model", "--check"});
    EXPECT_EQ(current.status, 0) << current.out;
    const command_result errors = run_idim({"validate", output() + "/robot.yaml", output() + "/after.json",
                                            (folder_.path() / "valid.csv").string(), "--json", "-"});
    ASSERT_EQ(errors.status, 0) << errors.err;
    EXPECT_EQ(json::parse(errors.out)["relative_error"], result["after"]["validation"]["relative_error"]);
    EXPECT_NE(read_text(output() + "/model.diff").find("+"), std::string::npos);
    EXPECT_NE(read_text(output() + "/report.md").find("spring at j2"), std::string::npos);
}

// Shapes are searched again from where they stand: what remains of the way there is far below the noise.
TEST_F(RefineCommand, GoesOnFromWhatAnEarlierRunFound) {
    const json whole = refine(spring_and_ripple);
    ASSERT_EQ(effects_of(whole), (std::set<std::string>{"spring j2", "torque_ripple j1"}));
    EXPECT_EQ(run({"--most", "1"})["steps"].size(), 1U);
    const json resumed = run({"--resume"});
    EXPECT_EQ(effects_of(resumed), effects_of(whole));
    EXPECT_EQ(resumed["steps"][0]["p_value"], whole["steps"][0]["p_value"]);
    EXPECT_EQ(resumed["before"], whole["before"]);
    EXPECT_NEAR(resumed["after"]["validation"]["relative_error"], whole["after"]["validation"]["relative_error"],
                1e-3 * double(whole["after"]["validation"]["relative_error"]));
    const json again = run({"--resume"});
    EXPECT_EQ(effects_of(again), effects_of(whole));
}

TEST_F(RefineCommand, AnInterruptedRunLeavesWhatItFoundAndCanBeResumed) {
    write_files(spring_and_ripple);
    std::vector<std::string> words = {
        "bash", "-c",
        // The first effect that is found is the sign to interrupt: the second is being looked for then.
        "exec 3< <(\"$@\" 2>&1 >/dev/null & echo $!; wait $!; echo status $?); read -r pid <&3\n"
        "while read -r line <&3; do case $line in *': p '*) kill -INT \"$pid\";; 'status '*) exit \"${line#* }\";; "
        "esac; done",
        "bash", IDIM_COMMAND};
    const std::vector<std::string> rest = words_with({});
    words.insert(words.end(), rest.begin(), rest.end());
    const command_result answer = run_program(words);
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json interrupted = json::parse(read_text(output() + "/refine.json"));
    EXPECT_TRUE(interrupted.value("interrupted", false));
    EXPECT_EQ(interrupted["steps"].size(), 1U);
    const json resumed = run({"--resume"});
    EXPECT_FALSE(resumed.contains("interrupted"));
    EXPECT_EQ(effects_of(resumed), (std::set<std::string>{"spring j2", "torque_ripple j1"}));
}

TEST_F(RefineCommand, ResumesNothingThatIsNotOfThisRobotAndTheseRows) {
    write_files(spring_and_ripple);
    const command_result missing = run_idim(words_with({"--resume"}));
    EXPECT_EQ(missing.status, 2);
    EXPECT_NE(missing.err.find("refine.json: cannot be read, expected what refine wrote before"), std::string::npos)
        << missing.err;
    json found = run({"--most", "1"});
    const command_result filtered = run_idim(words_with({"--resume", "--cutoff", "5", "--decimation", "10"}));
    EXPECT_EQ(filtered.status, 2);
    EXPECT_NE(filtered.err.find("refine.json: band: made from rows of another band"), std::string::npos)
        << filtered.err;
    found["steps"][0]["joints"] = {"elbow"};
    folder_.write("refined/refine.json", found.dump());
    const command_result renamed = run_idim(words_with({"--resume"}));
    EXPECT_EQ(renamed.status, 2);
    EXPECT_NE(renamed.err.find("the robot has no joint \"elbow\""), std::string::npos) << renamed.err;
}

TEST_F(RefineCommand, DiagnosisNamesTheEffectAndAddsNothing) {
    const std::string robot = folder_.write("arm.yaml",
                                            "name: arm\ngravity: [0, 0, 0]\njoints:\n  - {name: j1, theta: q}\n"
                                            "  - {name: j2, d: 0.5, theta: q}\n"
                                            "effects: [viscous_friction, coulomb_friction]\n");
    const undeclared spring = [](const instant& s) { return std::array<double, 2>{0.0, 0.04 * s.q[1]}; };
    const std::string log = folder_.write("ident.csv", log_text(0, 1, spring));
    const command_result answer = run_idim({"diagnose", robot, log, "--json", "-"});
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json result = json::parse(answer.out);
    EXPECT_EQ(result["verdict"], "unexplained_residual");
    EXPECT_EQ(result["candidates"][0]["effect"], "spring");
    EXPECT_TRUE(result["steps"].empty());
}

// A hose between two links: its torque at joint 2 is the product of both positions, which no entry of the catalogue
// has.
TEST_F(RefineCommand, ProposesAnEffectForStructureThatNoKnownOneFits) {
    constexpr double truth = 0.05;  // N*m/rad^2
    const json result = refine([](const instant& s) { return std::array<double, 2>{0.0, truth * s.q[0] * s.q[1]}; });
    ASSERT_EQ(result["unexplained"].size(), 1U) << result["unexplained"].dump();
    const json& structure = result["unexplained"][0];
    EXPECT_EQ(structure["joint"], "j2");
    EXPECT_EQ(std::set<std::string>(structure["signals"].begin(), structure["signals"].end()),
              (std::set<std::string>{"q1", "q2"}));
    EXPECT_GT(structure["explained_fraction"], 0.5);
    EXPECT_EQ(structure["proposed"], "proposed_1");
    expect_one(result, "proposed_1", {"j2"});
    EXPECT_EQ(result["steps"][0]["torque"], "P1a*q*q_from");
    EXPECT_EQ(result["steps"][0]["from"], json::array({"j1"}));
    expect_near(result["steps"][0]["parameters"]["P1a"], truth);
    EXPECT_NE(read_text(output() + "/proposed_1.yaml").find("proposed: true\n"), std::string::npos);
    EXPECT_NE(read_text(output() + "/robot.yaml").find("{effect: proposed_1, joints: [j2], from: [j1]}"),
              std::string::npos);
}

}  // namespace

}  // namespace idim::test
