// identify --period and the bands of validate on logs: what they write and what they refuse.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "support/command.hpp"
#include "support/rail_robot.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

/// One mass of 5 kg on a rail at 200 Hz, tau = 5 qdd + 2 qd + noise of 0.5 N, six periods of 4 s behind 1 s of rest.
class PeriodicCommand : public ::testing::Test {
  protected:
    void SetUp() override {
        robot_ = folder_.write("rail.yaml", rail_text("viscous_friction"));
        log_ = folder_.write("log.csv", rail_log(6.0, 1));
        result_ = (folder_.path() / "result.json").string();
    }
    static std::string rail_log(double periods, int seed, double stretch = 0.0) {
        std::string text = "t,q1,tau1\n";
        std::mt19937 random(static_cast<unsigned>(seed));
        std::normal_distribution<double> noise(0.0, 0.5);
        const int moving = static_cast<int>(periods * 800.0);
        for (int k = 0; k < 200 + moving; ++k) {
            // The motion starts smoothly: q = 1 - cos, and 1 - cos of three times the frequency.
            const double w = 0.5 * std::numbers::pi;
            const double s = std::max(k - 200, 0) / 200.0;
            const double t = s + stretch * s * s;
            const double pace = 1.0 + 2.0 * stretch * s;  // dt/ds
            const double q = 0.4 * (1.0 - std::cos(w * t)) + 0.1 * (1.0 - std::cos(3.0 * w * t));
            const double by_t = 0.4 * w * std::sin(w * t) + 0.3 * w * std::sin(3.0 * w * t);
            const double twice = w * w * (0.4 * std::cos(w * t) + 0.9 * std::cos(3.0 * w * t));
            const double qd = by_t * pace;
            const double qdd = k > 200 ? twice * pace * pace + by_t * 2.0 * stretch : 0.0;
            text += fmt::format("{:.3f},{},{}\n", k / 200.0, q, 5.0 * qdd + 2.0 * qd + noise(random));
        }
        return text;
    }
    command_result identify(const std::string& log, std::vector<std::string> options) {
        std::filesystem::remove(result_);
        std::vector<std::string> arguments = {"identify", robot_, log, "--json", result_, "--cutoff", "20"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_idim(arguments);
    }
    json result() const { return json::parse(read_text(result_)); }
    /// The one line of a refusal; no result is left behind.
    std::string refusal(const std::string& log, const std::vector<std::string>& options) {
        const command_result answer = identify(log, options);
        EXPECT_EQ(answer.status, 2) << answer.err;
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        EXPECT_FALSE(std::filesystem::exists(result_));
        return answer.err;
    }

    temporary_folder folder_;
    std::string robot_, log_, result_;
};

TEST_F(PeriodicCommand, FoundPeriodsAreAveragedAndReportedByBothWeightedMethods) {
    const command_result answer = identify(log_, {"--period", "auto"});
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.out.find("periods of 4 s (800 samples)"), std::string::npos) << answer.out;
    EXPECT_NE(answer.out.find("torque covariance"), std::string::npos) << answer.out;
    const json found = result();
    const json& log = found["periodic"]["logs"][0];
    EXPECT_TRUE(found["periodic"]["averaged"].get<bool>());
    EXPECT_EQ(log["period_samples"], 800);
    EXPECT_DOUBLE_EQ(log["period"].get<double>(), 4.0);
    // Six periods behind the rest; the filter takes a quarter of a second off the last.
    EXPECT_EQ(log["periods"], 5);
    EXPECT_GE(log["transient_dropped"].get<double>(), 1.0);
    EXPECT_TRUE(log["covariance"] == "pooled" || log["covariance"] == "shrunk");
    for (int k = 0; k < 2; ++k) {
        const json& parameter = found["parameters"][k];
        const double error = parameter["value"].get<double>() - (k == 0 ? 5.0 : 2.0);
        EXPECT_LT(std::abs(error), 4.0 * parameter["std"].get<double>()) << parameter;
        // Both estimate the variance of the mean: within the factor of 5 periods.
        EXPECT_NEAR(std::log(parameter["std_of_periods"].get<double>() / parameter["std"].get<double>()), 0.0, 1.1);
    }

    ASSERT_EQ(identify(log_, {"--period", "4", "--method", "cwls"}).status, 0);
    const json consistent = result();
    EXPECT_EQ(consistent["periodic"]["logs"][0]["periods"], 5);
    // No constraint is active, so that the methods agree to what the proof of the optimum leaves open.
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(consistent["parameters"][k]["value"].get<double>(), found["parameters"][k]["value"].get<double>(),
                    1e-4);
        EXPECT_NEAR(consistent["parameters"][k]["std"].get<double>() / found["parameters"][k]["std"].get<double>(), 1.0,
                    1e-2);
    }
}

TEST_F(PeriodicCommand, RefusesWhatIsNotPeriodicInOneLine) {
    EXPECT_NE(refusal(log_, {"--period", "3.5"}).find("log.csv: --period: the periods do not repeat"),
              std::string::npos);
    EXPECT_NE(refusal(log_, {"--period", "16"}).find("--period: fewer than two periods"), std::string::npos);
    EXPECT_NE(refusal(log_, {"--period", "soon"}).find("expected auto or a positive number"), std::string::npos);
    EXPECT_NE(refusal(log_, {"--period", "4", "--method", "irls"}).find("expected --method ols, wls or cwls"),
              std::string::npos);
}

TEST_F(PeriodicCommand, AnAperiodicLogFallsBackToWeightsPerJointAndSaysSo) {
    const std::string sweep = folder_.write("sweep.csv", rail_log(5.0, 2, 0.02));
    ASSERT_EQ(identify(sweep, {}).status, 0);
    const json plain = result();
    EXPECT_FALSE(plain.contains("periodic"));
    const command_result answer = identify(sweep, {"--period", "auto"});
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.out.find("not averaged, weights per joint: "), std::string::npos) << answer.out;
    const json looked = result();
    EXPECT_FALSE(looked["periodic"]["averaged"].get<bool>());
    EXPECT_NE(looked["periodic"]["reason"].get<std::string>().find("nothing repeats"), std::string::npos);
    EXPECT_EQ(looked["parameters"], plain["parameters"]);
}

TEST_F(PeriodicCommand, BandsCoverOtherDataOfTheSameNoiseAndNotOfAnotherRobot) {
    ASSERT_EQ(identify(log_, {"--period", "auto"}).status, 0);
    const std::string other = folder_.write("other.csv", rail_log(5.0, 3, 0.02));
    const std::string errors = (folder_.path() / "errors.json").string();
    const std::string series = (folder_.path() / "series.csv").string();
    const command_result answer = run_idim({"validate", robot_, result_, other, "--json", errors, "--series", series});
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_NE(answer.out.find("as it should be"), std::string::npos) << answer.out;
    const json band = json::parse(read_text(errors))["joints"][0]["band"];
    EXPECT_EQ(band["level"], 0.95);
    EXPECT_NEAR(band["covered"].get<double>(), 0.95, 1.5 * band["covered_margin"].get<double>());
    EXPECT_LT(band["deviation_of_parameters"].get<double>(), 0.5 * band["deviation_of_noise"].get<double>());
    const std::string text = read_text(series);
    EXPECT_EQ(text.substr(0, text.find('\n')), "log,joint,t,tau,predicted,low,high");
    EXPECT_EQ(text.find(",,"), std::string::npos);

    // The same rail with a mass of 6 kg.
    json heavier = result();
    heavier["parameters"][0]["value"] = 6.0;
    const std::string wrong = folder_.write("wrong.json", heavier.dump());
    const command_result larger = run_idim({"validate", robot_, wrong, other});
    EXPECT_NE(larger.out.find("errors are larger here"), std::string::npos) << larger.out;
}

}  // namespace

}  // namespace idim::test
