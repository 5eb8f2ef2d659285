// Which rows are left out near zero speed, and that any regressor can be sampled at the rows of another.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "idim/observation.hpp"
#include "idim/zero_phase_filter.hpp"

namespace idim {
namespace {

constexpr double w = 2.0 * std::numbers::pi * 0.25;  // four seconds a period
constexpr double rate = 100.0;

/// Joint 1 moves as sin(w t), joint 2 at the same time or not at all, `drift` being the deviation of what its encoder
/// shows.
filtered_samples swing(Eigen::Index n, double second, double drift) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    filtered_samples samples;
    samples.file = "swing.csv";
    samples.rate = rate;
    samples.t = Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) / rate;
    samples.q.resize(n, 2);
    samples.q.col(0) = (w * samples.t.array()).sin();
    samples.q.col(1) = second * (w * samples.t.array()).cos();
    samples.qd.resize(n, 2);
    samples.qd.col(0) = w * (w * samples.t.array()).cos();
    samples.qd.col(1) = -second * w * (w * samples.t.array()).sin();
    samples.qdd = -w * w * samples.q;
    for (Eigen::Index k = 0; k < n; ++k) {
        samples.q(k, 1) += drift * normal(random);
        samples.qd(k, 1) += drift * rate * normal(random);
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

TEST(RowSelection, OfAnyMinimumSpeedZeroIsAllRows) {
    EXPECT_EQ(select_rows(swing(1601, 1.0, 0.0), slower_than(0.0, 10)), all_rows(2, 161));
}

TEST(RowSelection, MovingJointLosesExactlyItsRowsAroundReversals) {
    const filtered_samples samples = swing(1601, 0.5, 0.0);
    const row_selection kept = select_rows(samples, slower_than(0.1));
    for (int joint = 0; joint < 2; ++joint) {
        const Eigen::VectorXd speed = samples.qd.col(joint);
        std::vector<Eigen::Index> expected;
        for (Eigen::Index k = 0; k < speed.size(); ++k) {
            if (std::abs(speed[k]) >= 0.1 * speed.cwiseAbs().maxCoeff()) {
                expected.push_back(k);
            }
        }
        EXPECT_EQ(kept[joint], expected);
        // Speed below a tenth of the top of a sinusoid: 2 asin(0.1) / pi of the time.
        EXPECT_NEAR(static_cast<double>(kept[joint].size()) / 1601.0, 1.0 - 2.0 * std::asin(0.1) / std::numbers::pi,
                    0.005);
    }
    EXPECT_NE(kept[0], kept[1]) << "each joint by its own speed";
}

TEST(RowSelection, IsJudgedByTheDecimatedSpeed) {
    const filtered_samples samples = swing(1601, 1.0, 0.0);
    const filter_choice choice = slower_than(0.2, 10);
    const Eigen::VectorXd speed = decimate(samples.qd, 10).col(0);
    const std::vector<Eigen::Index> kept = select_rows(samples, choice)[0];
    ASSERT_LT(kept.size(), 161U);
    std::size_t next = 0;
    for (Eigen::Index k = 0; k < speed.size(); ++k) {
        const bool stays = next < kept.size() && kept[next] == k;
        EXPECT_EQ(stays, std::abs(speed[k]) >= 0.2 * speed.cwiseAbs().maxCoeff()) << k;
        next += stays ? 1 : 0;
    }
}

TEST(RowSelection, HeldJointKeepsAllItsRows) {
    for (const double drift : {0.0, 1e-6, 1e-4}) {  // nothing, and noise that a tenth of its top speed would thin
        const row_selection kept = select_rows(swing(1601, 0.0, drift), slower_than(0.1));
        EXPECT_LT(kept[0].size(), 1601U);
        EXPECT_EQ(kept[1].size(), 1601U) << drift;
    }
}

TEST(RowSelection, TopSpeedIsThatOfItsOwnLog) {
    filtered_samples slow = swing(1601, 1.0, 0.0);
    slow.qd *= 1e-3;
    const filtered_samples fast = swing(1601, 1.0, 0.0);
    const observation rows = observe(pair_model(2), {slow, fast}, slower_than(0.01));
    EXPECT_EQ(rows.blocks[0].kept, rows.blocks[1].kept);
    EXPECT_GT(rows.blocks[0].kept[0].size(), 1550U);
}

TEST(RowSelection, ARestBetweenMotionsIsLeftOut) {
    filtered_samples samples = swing(1601, 1.0, 0.0);
    samples.qd.col(0).segment(700, 300).setZero();
    for (const Eigen::Index k : select_rows(samples, slower_than(0.01))[0]) {
        EXPECT_TRUE(k < 700 || k >= 1000) << k;
    }
}

TEST(RowSelection, RowsAreThoseOfTheFullObservation) {
    const filtered_samples samples = swing(1601, 0.5, 0.0);
    const observation_block full = observe(pair_model(2), {samples}, slower_than(0.0, 10)).blocks[0];
    const observation rows = observe(pair_model(2), {samples}, slower_than(0.1, 10));
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
    // Instruments: another regressor along a simulated motion, whose own slow rows stand elsewhere.
    const filter_choice choice = slower_than(0.1, 10);
    const filtered_samples measured = swing(1601, 0.5, 0.0);
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
    const filtered_samples samples = swing(100, 1.0, 0.0);
    const filter_choice choice = slower_than(0.0);
    const auto rows = [&](const std::vector<row_selection>& kept) { observe(pair_model(2), {samples}, choice, kept); };
    EXPECT_NO_THROW(rows({{{0, 5, 99}, {}}}));
    EXPECT_THROW(rows({}), std::invalid_argument);
    EXPECT_THROW(rows({all_rows(1, 100)}), std::invalid_argument);
    EXPECT_THROW(rows({{{0, 100}, {}}}), std::invalid_argument);
    EXPECT_THROW(rows({{{-1, 3}, {}}}), std::invalid_argument);
    EXPECT_THROW(rows({{{3, 3}, {}}}), std::invalid_argument);
}

}  // namespace
}  // namespace idim
