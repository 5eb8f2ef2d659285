// identify --method cwls on logs: what it writes, what it refuses, and what it makes of measured robots.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/command.hpp"
#include "support/rail_robot.hpp"
#include "support/shared_data.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

class ConsistencyCommand : public ::testing::Test {
  protected:
    /// One mass of 5 kg on a rail at 200 Hz: tau = 5 qdd + 2 qd - 0.2 sign(qd), a friction that cannot be.
    void SetUp() override {
        robot_ = folder_.write("rail.yaml", rail_text("viscous_friction, coulomb_friction"));
        std::string text = "t,q1,tau1\n";
        for (int k = 0; k < 4000; ++k) {
            const double t = k / 200.0;
            const double qd = std::cos(t) + 1.5 * std::cos(3.0 * t);
            const double qdd = -std::sin(t) - 4.5 * std::sin(3.0 * t);
            const double tau = 5.0 * qdd + 2.0 * qd - 0.2 * (qd > 0.0 ? 1.0 : -1.0);
            text += fmt::format("{:.3f},{},{}\n", t, std::sin(t) + 0.5 * std::sin(3.0 * t), tau);
        }
        log_ = folder_.write("log.csv", text);
    }
    command_result identify(std::vector<std::string> options) {
        std::vector<std::string> arguments = {"identify", robot_, log_, "--method", "cwls", "--json", result_file()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_idim(arguments);
    }
    json result() const { return json::parse(read_text(result_file())); }
    std::string result_file() const { return (folder_.path() / "result.json").string(); }
    /// The one line of refused options; no result is left behind.
    std::string refusal(const std::vector<std::string>& options) {
        std::filesystem::remove(result_file());
        const command_result answer = identify(options);
        EXPECT_EQ(answer.status, 2) << answer.err;
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        EXPECT_FALSE(std::filesystem::exists(result_file()));
        return answer.err;
    }

    temporary_folder folder_;
    std::string robot_, log_;
};

TEST_F(ConsistencyCommand, AFrictionThatCannotBeIsHeldAtZeroAndFlagged) {
    const command_result answer = identify({});
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json found = result();
    EXPECT_EQ(found["method"], "cwls");
    EXPECT_TRUE(found["converged"].get<bool>());
    const json& friction = found["parameters"][2];
    EXPECT_EQ(friction["name"], "Fc1");
    EXPECT_TRUE(friction["at_bound"].get<bool>());
    EXPECT_TRUE(friction["std"].is_null());
    EXPECT_GT(friction["value"].get<double>(), 0.0);
    EXPECT_LT(friction["value"].get<double>(), 1e-6);
    EXPECT_FALSE(found["parameters"][0]["at_bound"].get<bool>());
    EXPECT_GT(found["parameters"][0]["std"].get<double>(), 0.0);
    const json& consistency = found["consistency"];
    EXPECT_LE(consistency["relative_gap"].get<double>(), 1e-8);
    ASSERT_EQ(consistency["active"].size(), 1U);
    EXPECT_EQ(consistency["active"][0]["constraint"], "Fc1 >= 0");
    EXPECT_EQ(consistency["links"][0]["name"], "link of slide");
    EXPECT_GT(consistency["inertia_matrix"]["cwls"]["smallest_eigenvalue"].get<double>(), 4.0);
    EXPECT_GE(found["residual"]["relative_error"].get<double>(), consistency["relative_error_of_wls"].get<double>());
    EXPECT_NE(answer.out.find("active: Fc1 >= 0"), std::string::npos) << answer.out;
}

TEST_F(ConsistencyCommand, AMassBoundHolds) {
    ASSERT_EQ(identify({"--mass-bounds", "slide=6:9"}).status, 0);
    const json found = result();
    EXPECT_NEAR(found["parameters"][0]["value"].get<double>(), 6.0, 1e-6);
    EXPECT_TRUE(found["parameters"][0]["at_bound"].get<bool>());
    EXPECT_EQ(found["consistency"]["active"][0]["constraint"], "mass of the link of slide >= 6 kg");
}

TEST_F(ConsistencyCommand, ItsResultIsAPriorAndValidates) {
    ASSERT_EQ(identify({"--com-box=-0.1:0.1,-0.1:0.1,0.2:0.4"}).status, 0);
    const std::string first = folder_.write("first.json", read_text(result_file()));
    EXPECT_EQ(run_idim({"validate", robot_, first, log_}).status, 0);
    ASSERT_EQ(identify({"--prior", first}).status, 0);
    const json before = json::parse(read_text(first))["consistency"]["links"][0];
    const json after = result()["consistency"]["links"][0];
    // The data says nothing of the centre: that of the prior is kept.
    EXPECT_NEAR(after["centre"][2].get<double>(), before["centre"][2].get<double>(), 1e-4);
    EXPECT_GT(after["centre"][2].get<double>(), 0.19);
}

TEST_F(ConsistencyCommand, WhatCannotBeIsNamedInOneLine) {
    EXPECT_NE(refusal({"--mass-bounds", "3:4", "--total-mass", "5:6"}).find("total mass: 5 to 6 kg, but"),
              std::string::npos);
    EXPECT_NE(refusal({"--mass-bounds", "4:3"}).find("--mass-bounds: \"4:3\""), std::string::npos);
    EXPECT_NE(refusal({"--mass-bounds", "wrist=1:2"}).find("link of slide"), std::string::npos);
    EXPECT_NE(refusal({"--mass-bounds", "heavy:"}).find("LOW:HIGH"), std::string::npos);
    EXPECT_NE(refusal({"--com-box", "0:1,0:1"}).find("three intervals"), std::string::npos);
    EXPECT_NE(refusal({"--prior-strength", "1"}).find("--prior FILE"), std::string::npos);
    EXPECT_NE(refusal({"--prior", folder_.write("prior.yaml", "M1: 5\n")}).find("prior.yaml: XX1: missing"),
              std::string::npos);
    const std::string point = folder_.write(
        "point.yaml", "{XX1: 0, XY1: 0, XZ1: 0, YY1: 0, YZ1: 0, ZZ1: 0, MX1: 0, MY1: 0, MZ1: 0, M1: 5}\n");
    EXPECT_NE(refusal({"--prior", point}).find("link of slide is not consistent"), std::string::npos);
    EXPECT_NE(refusal({"--mass-bounds", ":0.1", "--floor", "1"}).find("mass of the link of slide"), std::string::npos);
}

/// Consistent parameters of a measured robot, proven optimal, with M(q) > 0 everywhere.
void expect_consistent(const json& found, bool full = true) {
    const json& consistency = found["consistency"];
    EXPECT_TRUE(found["converged"].get<bool>()) << found["message"];
    EXPECT_LE(consistency["relative_gap"].get<double>(), 1e-8);
    for (const json& link : consistency["links"]) {
        EXPECT_GT(link["mass"].get<double>(), 0.0);
        EXPECT_GT(link["smallest_central_eigenvalue"].get<double>(), 0.0);
        EXPECT_TRUE(!full || link["smallest_pseudo_eigenvalue"].get<double>() > 0.0);
    }
    EXPECT_GT(consistency["inertia_matrix"]["cwls"]["smallest_eigenvalue"].get<double>(), 0.0);
    EXPECT_EQ(consistency["inertia_matrix"]["configurations"], 100000);
}

class MeasuredConsistency : public ::testing::Test {
  protected:
    json identify(const std::string& robot, const std::string& log, const std::string& method,
                  const std::string& consistency = "full") {
        const std::string file = (folder_.path() / (method + ".json")).string();
        const command_result answer = run_idim(
            {"identify", robot_file(robot), log, "--method", method, "--consistency", consistency, "--json", file});
        EXPECT_EQ(answer.status, 0) << answer.err;
        return answer.status == 0 ? json::parse(read_text(file)) : json();
    }
    double error_on(const std::string& robot, const std::string& log, const std::string& method) {
        const std::string result = (folder_.path() / (method + ".json")).string();
        const std::string file = (folder_.path() / "validation.json").string();
        EXPECT_EQ(run_idim({"validate", robot_file(robot), result, log, "--json", file}).status, 0);
        return json::parse(read_text(file))["relative_error"];
    }

    temporary_folder folder_;
};

/// Points (of 1) by which the error on other data may exceed that without constraints. These robots' torques were
/// measured at the links, so that least squares gives every rotor inertia a negative value; with them held at zero,
/// full consistency costs a little more than 0.1 %.
void expect_cost(double constrained, double unconstrained, double points) {
    EXPECT_LE(constrained, unconstrained + points);
    printf("on other data %.3f %%, without constraints %.3f %%\n", 100.0 * constrained, 100.0 * unconstrained);
}

TEST_F(MeasuredConsistency, PandaIsPredictedAlmostAsWellAsWithoutConstraints) {
    IDIM_REQUIRE_DATA(ident, "panda/ident.csv.gz");
    IDIM_REQUIRE_DATA(valid, "panda/valid.csv.gz");
    identify("panda", ident->string(), "wls");
    const double wls = error_on("panda", valid->string(), "wls");
    expect_consistent(identify("panda", ident->string(), "cwls", "spatial"), false);
    expect_cost(error_on("panda", valid->string(), "cwls"), wls, 0.001);
    expect_consistent(identify("panda", ident->string(), "cwls"));
    expect_cost(error_on("panda", valid->string(), "cwls"), wls, 0.0015);
}

TEST_F(MeasuredConsistency, Xmate7pIsPredictedAlmostAsWellAsWithoutConstraints) {
    IDIM_REQUIRE_DATA(ident, "xmate7p/ident_t1.csv.gz");
    IDIM_REQUIRE_DATA(valid, "xmate7p/valid_t2.csv.gz");
    identify("xmate7p", ident->string(), "wls");
    expect_consistent(identify("xmate7p", ident->string(), "cwls"));
    expect_cost(error_on("xmate7p", valid->string(), "cwls"), error_on("xmate7p", valid->string(), "wls"), 0.002);
}

TEST_F(MeasuredConsistency, Tx40HasLinksThatCouldExist) {
    IDIM_REQUIRE_DATA(log, "tx40/ident.csv.gz");
    const json found = identify("tx40", log->string(), "cwls");
    expect_consistent(found);
    // What is missing in the wrist (a coupling of joints 5 and 6) cannot be hidden in impossible links: the cost is
    // visible.
    const double wls = found["consistency"]["relative_error_of_wls"];
    EXPECT_LE(found["residual"]["relative_error"].get<double>(), wls + 0.005);
}

}  // namespace

}  // namespace idim::test
