// Structure of the residual that no candidate names, on rows made here: how often it is seen where there is none, and
// what is said of it where it is.
#include "tracing/residual_structure.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "support/noise.hpp"
#include "tracing/structure_proposal.hpp"

namespace idim::test {

namespace {

constexpr Eigen::Index moving_rows = 500;
constexpr double moving_rate = 15.0;  // Hz

/// Two joints along sums of sines, `which` other ones in each log; their models are inertia, friction and an offset.
/// The rows are all samples, none of them at a reversal.
traced_log moving_log(int which, bool held_back) {
    constexpr std::array<std::array<double, 3>, 4> frequency = {
        {{0.11, 0.53, 0.89}, {0.13, 0.61, 1.03}, {0.07, 0.43, 0.97}, {0.17, 0.67, 0.83}}};
    traced_log log;
    log.held_back = held_back;
    log.rows.rate = log.samples.rate = moving_rate;
    log.samples.t = log.rows.t = Eigen::VectorXd::LinSpaced(moving_rows, 0.0, (moving_rows - 1) / moving_rate);
    log.samples.q = log.samples.qd = log.samples.qdd = log.tau_rigid = Eigen::MatrixXd::Zero(moving_rows, 2);
    for (Eigen::Index j = 0; j < 2; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double w = 2.0 * M_PI * frequency[static_cast<std::size_t>(2 * which + j)][i];
            const double amplitude = 0.8 / static_cast<double>(i + 1);
            const Eigen::ArrayXd angle = w * log.samples.t.array() + 0.7 * static_cast<double>(i) + which;
            log.samples.q.col(j).array() += amplitude * angle.sin();
            log.samples.qd.col(j).array() += amplitude * w * angle.cos();
            log.samples.qdd.col(j).array() -= amplitude * w * w * angle.sin();
        }
        log.tau_rigid.col(j) = log.samples.qdd.col(j);
        Eigen::MatrixXd W = Eigen::MatrixXd::Zero(moving_rows, 6);
        W.middleCols(3 * j, 3) << log.samples.qdd.col(j), log.samples.qd.col(j), Eigen::VectorXd::Ones(moving_rows);
        log.rows.W.push_back(W);
        log.rows.Y.emplace_back(W * Eigen::VectorXd::Constant(6, 1.5));
        log.reversal.push_back(row_flags::Constant(moving_rows, false));
    }
    log.rows.kept = all_rows(2, moving_rows);
    return log;
}

/// A log to fit and one held back, noise at both joints.
std::vector<traced_log> noisy_logs(double memory, std::mt19937_64& random) {
    std::vector<traced_log> logs = {moving_log(0, false), moving_log(1, true)};
    for (traced_log& log : logs) {
        for (Eigen::VectorXd& Y : log.rows.Y) {
            Y += ar1_noise(moving_rows, memory, random);
        }
    }
    return logs;
}

TEST(ResidualStructure, IsSeldomSeenInCorrelatedNoise) {
    // The shifts are tested at 5 % over both joints, and the data held back has to agree: of 60 draws 3 at the most on
    // average, and three deviations more.
    constexpr int draws = 60;
    std::mt19937_64 random(1);
    int alarms = 0;
    for (int i = 0; i < draws; ++i) {
        const std::vector<traced_log> logs = noisy_logs(0.8, random);
        alarms += find_dependences(fit_with_own_noise(logs, {})).empty() ? 0 : 1;
    }
    EXPECT_LE(alarms, 8);
}

TEST(ResidualStructure, OfTwoSignalsIsFoundAtItsJointWithItsForm) {
    std::mt19937_64 random(2);
    std::vector<traced_log> logs = noisy_logs(0.5, random);
    for (traced_log& log : logs) {
        log.rows.Y[1] += 3.0 * log.samples.q.col(0).cwiseProduct(log.samples.q.col(1));
    }
    const trace_fit fit = fit_with_own_noise(logs, {});
    const std::vector<signal_dependence> found = find_dependences(fit);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].joint, 1);
    std::set<std::string> names;
    for (const signal_source& source : found[0].signals) {
        names.insert(source.name());
    }
    EXPECT_EQ(names, (std::set<std::string>{"q1", "q2"}));
    // The variance of the product, of two positions of deviation 0.66 or so, beside that of the noise.
    EXPECT_GT(found[0].explained_fraction, 0.4);
    const std::optional<proposed_torque> proposal = propose(fit, found[0]);
    ASSERT_TRUE(proposal.has_value());
    EXPECT_EQ(proposal->terms, std::vector<std::string>{"q*q_from"});
    EXPECT_EQ(proposal->units, std::vector<std::string>{"N*m/rad^2"});
    EXPECT_EQ(proposal->from, 0);
}

TEST(ResidualStructure, WhereFewRowsTellASurfaceIsStillFound) {
    // Friction that changes with the other joint's position. Where fitted, that position nearly follows the speed, so
    // that rows hardly come where the two differ; those held back do. Nothing is made up there.
    std::mt19937_64 random(4);
    std::vector<traced_log> logs = noisy_logs(0.5, random);
    Eigen::MatrixXd& q = logs.front().samples.q;
    q.col(1) = 0.2 * logs.front().samples.qd.col(0) + 0.3 * q.col(1);
    for (traced_log& log : logs) {
        log.rows.Y[0].array() += 3.0 * log.samples.qd.col(0).array().sign() * log.samples.q.col(1).array();
    }
    const std::vector<signal_dependence> found = find_dependences(fit_with_own_noise(logs, {}));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].joint, 0);
    ASSERT_EQ(found[0].signals.size(), 2U);
    EXPECT_EQ(found[0].signals[0].name(), "qd1");
    EXPECT_EQ(found[0].signals[1].name(), "q2");
}

TEST(ResidualStructure, OfOneSignalIsNotSaidToBeOfTwo) {
    std::mt19937_64 random(3);
    std::vector<traced_log> logs = noisy_logs(0.5, random);
    for (traced_log& log : logs) {
        log.rows.Y[0].array() += 2.0 * (2.0 * log.samples.q.col(0).array()).cos();
    }
    const trace_fit fit = fit_with_own_noise(logs, {});
    const std::vector<signal_dependence> found = find_dependences(fit);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].joint, 0);
    ASSERT_EQ(found[0].signals.size(), 1U);
    EXPECT_EQ(found[0].signals[0].name(), "q1");
}

}  // namespace

}  // namespace idim::test
