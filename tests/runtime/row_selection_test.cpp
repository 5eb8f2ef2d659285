// Which rows are left out at rest, and that any regressor can be sampled at the rows of another.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "idim/observation.hpp"

namespace idim {
namespace {

constexpr double swing_frequency = 2.0 * std::numbers::pi * 0.25;  // four seconds a period
constexpr double swing_rate = 100.0;

/// Time of a motion that stands still for three seconds from `pause` on.
Eigen::ArrayXd paused(const Eigen::VectorXd& t, double pause) {
    return t.array().min(pause) + (t.array() - pause - 3.0).max(0.0);
}

/// 16 s at 100 Hz. Joint 1 moves as sin(w t), joint 2 as `second` cos(w t) at w = swing_frequency, with the deviation
/// `noise` of what its encoder shows; both reverse every two seconds and rest at one reversal, joint 1 from 5 s and
/// joint 2 from 8 s on.
filtered_samples swing(double second, double noise = 0.0) {
    constexpr Eigen::Index n = 1601;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    filtered_samples samples;
    samples.file = "swing.csv";
    samples.rate = swing_rate;
    samples.t = Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) / swing_rate;
    const Eigen::ArrayXd phase = swing_frequency * paused(samples.t, 5.0);
    const Eigen::ArrayXd other = swing_frequency * paused(samples.t, 8.0);
    samples.q.resize(n, 2);
    samples.q << phase.sin().matrix(), second * other.cos().matrix();
    samples.qd.resize(n, 2);
    samples.qd << swing_frequency * phase.cos().matrix(), -second * swing_frequency * other.sin().matrix();
    samples.qdd = -swing_frequency * swing_frequency * samples.q;
    for (Eigen::Index k = 0; k < n; ++k) {
        samples.q(k, 1) += noise * normal(random);
        samples.qd(k, 1) += noise * swing_rate * normal(random);
    }
    samples.tau = samples.q;
    return samples;
}

idim_model_interface pair_model(int parameters) {
    static const char* const names[] = {"a", "b", "c"};
    idim_model_interface model{};
    model.robot = "pair";
    model.dof = 2;
    model.n_base = parameters;
    model.joint_names = names;
    model.parameter_names = names;
    model.regressor = [](const double* q, const double* qd, const double*, double, const double*, double* W) {
        W[0] = q[0];
        W[1] = qd[0];
        W[2] = q[1];
        W[3] = qd[1];
    };
    return model;
}

filter_choice slower_than(double minimum_speed, int decimation = 1) {
    filter_choice choice{10.0, 4, decimation, ""};
    choice.minimum_speed = minimum_speed;
    return choice;
}

/// Whether `kept` names sample k.
bool holds_row(const std::vector<Eigen::Index>& kept, Eigen::Index k) {
    return std::binary_search(kept.begin(), kept.end(), k);
}

TEST(RowSelection, AtMinimumSpeedZeroIsAllRows) {
    EXPECT_EQ(select_rows(swing(1.0), slower_than(0.0, 10)), all_rows(2, 161));
}

TEST(RowSelection, JointLosesItsOwnRestsAndKeepsItsReversals) {
    const filtered_samples samples = swing(0.5);
    const row_selection kept = select_rows(samples, slower_than(0.01));
    const double rest[] = {5.0, 8.0};
    for (int joint = 0; joint < 2; ++joint) {
        const Eigen::VectorXd speed = samples.qd.col(joint).cwiseAbs();
        for (Eigen::Index k = 0; k < speed.size(); ++k) {
            // One sample moves by swing_frequency / 100 = 1.6 % of the top speed at a reversal: 1 % lies within a
            // sample of the rest.
            const bool resting = samples.t[k] > rest[joint] - 0.011 && samples.t[k] < rest[joint] + 3.011;
            EXPECT_EQ(holds_row(kept[joint], k), !(resting && speed[k] < 0.01 * speed.maxCoeff())) << k;
        }
        EXPECT_NEAR(static_cast<double>(kept[joint].size()), 1601.0 - 301.0, 2.0);
    }
}

TEST(RowSelection, IsJudgedByTheDecimatedSpeed) {
    // Ripples of 45 Hz hide the rest from the full rate, the decimation to 10 Hz takes them out.
    filtered_samples samples = swing(1.0);
    for (Eigen::Index k = 0; k < samples.samples(); ++k) {
        samples.qd(k, 0) += 0.1 * std::sin(2.0 * std::numbers::pi * 45.0 * samples.t[k] + 0.3);
    }
    EXPECT_GT(select_rows(samples, slower_than(0.01))[0].size(), 1560U);
    const std::vector<Eigen::Index> kept = select_rows(samples, slower_than(0.01, 10))[0];
    for (Eigen::Index k = 0; k < 161; ++k) {
        if (k < 48 || k > 82) {
            EXPECT_TRUE(holds_row(kept, k)) << k;
        }
        if (k > 55 && k < 75) {  // clear of the ringing of the filter at the ends of the rest
            EXPECT_FALSE(holds_row(kept, k)) << k;
        }
    }
}

TEST(RowSelection, HeldJointKeepsAllItsRows) {
    for (const double noise : {0.0, 1e-6, 1e-4}) {
        const row_selection kept = select_rows(swing(0.0, noise), slower_than(0.5));
        EXPECT_LT(kept[0].size(), 1601U);
        EXPECT_EQ(kept[1].size(), 1601U) << noise;
    }
}

TEST(RowSelection, TopSpeedIsThatOfItsOwnLog) {
    filtered_samples slow = swing(1.0);
    slow.qd *= 1e-3;
    const observation rows = observe(pair_model(2), {slow, swing(1.0)}, slower_than(0.01));
    EXPECT_EQ(rows.blocks[0].kept, rows.blocks[1].kept);
    EXPECT_GT(rows.blocks[0].kept[0].size(), 1290U);
}

TEST(RowSelection, RowsAreThoseOfTheFullObservation) {
    const filtered_samples samples = swing(0.5);
    const observation_block full = observe(pair_model(2), {samples}, slower_than(0.0, 10)).blocks[0];
    const observation rows = observe(pair_model(2), {samples}, slower_than(0.01, 10));
    const observation_block& block = rows.blocks[0];
    EXPECT_EQ(block.t, full.t);
    for (int joint = 0; joint < 2; ++joint) {
        EXPECT_EQ(block.W[joint], full.W[joint](block.kept[joint], Eigen::all));
        EXPECT_EQ(block.Y[joint], full.Y[joint](block.kept[joint]));
        EXPECT_LT(block.Y[joint].size(), full.Y[joint].size());
    }
    const double left = static_cast<double>(2 * 161 - rows.rows()) / (2.0 * 161.0);
    EXPECT_NEAR(rows.share_left_out(), left, 1e-15);
    EXPECT_EQ(observation{}.share_left_out(), 0.0);
}

TEST(RowSelection, OfOneMotionServesTheRegressorAlongAnother) {
    // Instruments: another regressor along a simulated motion, which does not rest at all.
    const filter_choice choice = slower_than(0.01, 10);
    const filtered_samples measured = swing(0.5);
    filtered_samples simulated = measured;
    simulated.q.array() += 0.01;
    simulated.qd.array() += 0.2;
    simulated.tau.resize(0, 0);
    const observation rows = observe(pair_model(2), {measured}, choice);
    ASSERT_NE(select_rows(simulated, choice), rows.blocks[0].kept);
    const observation instruments = observe(pair_model(2), {simulated}, choice, {rows.blocks[0].kept});
    EXPECT_EQ(instruments.blocks[0].kept, rows.blocks[0].kept);
    const observation_block full = observe(pair_model(2), {simulated}, slower_than(0.0, 10)).blocks[0];
    for (int joint = 0; joint < 2; ++joint) {
        ASSERT_EQ(instruments.blocks[0].W[joint].rows(), rows.blocks[0].W[joint].rows());
        EXPECT_EQ(instruments.blocks[0].W[joint], full.W[joint](rows.blocks[0].kept[joint], Eigen::all));
        EXPECT_EQ(instruments.blocks[0].Y[joint].size(), 0);
    }
}

TEST(RowSelection, ThatDoesNotFitTheLogsIsABrokenInvariant) {
    const filtered_samples samples = swing(1.0);
    const filter_choice choice = slower_than(0.0);
    const auto rows = [&](const std::vector<row_selection>& kept) { observe(pair_model(2), {samples}, choice, kept); };
    EXPECT_NO_THROW(rows({{{0, 5, 1600}, {}}}));
    EXPECT_THROW(rows({}), std::invalid_argument);
    EXPECT_THROW(rows({all_rows(1, 1601)}), std::invalid_argument);
    EXPECT_THROW(rows({{{0, 1601}, {}}}), std::invalid_argument);
    EXPECT_THROW(rows({{{-1, 3}, {}}}), std::invalid_argument);
    EXPECT_THROW(rows({{{3, 3}, {}}}), std::invalid_argument);
}

}  // namespace
}  // namespace idim
