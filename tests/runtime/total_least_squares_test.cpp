#include "idim/total_least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

#include "support/scara_rows.hpp"

namespace idim {
namespace {

TEST(TotalLeastSquares, FindsTheTruthOfExactRows) {
    const estimate fit = total_least_squares(test::scara_rows());
    ASSERT_EQ(fit.chi.size(), 8) << fit.message;
    // Rounding, times the condition number of the rows.
    EXPECT_LT((fit.chi - test::scara_truth()).norm(), 1e-9);
}

/// One joint, unit weights: the textbook solution from the last right singular vector of [W Y] in columns of norm 1.
TEST(TotalLeastSquares, IsTheLastRightSingularVectorOfTheScaledRows) {
    std::mt19937_64 random(3);
    observation rows;
    rows.dof = 1;
    rows.n_base = 3;
    observation_block block;
    block.t = Eigen::VectorXd::LinSpaced(200, 0.0, 10.0);
    block.kept = all_rows(1, 200);
    Eigen::MatrixXd W(200, 3);
    for (int c = 0; c < 3; ++c) {
        W.col(c) = test::white_noise(200, random);
    }
    const Eigen::VectorXd Y = W * Eigen::Vector3d(1.0, -2.0, 0.5) + 0.3 * test::white_noise(200, random);
    block.W = {W};
    block.Y = {Y};
    rows.blocks = {block};
    const Eigen::VectorXd scale = W.colwise().norm();
    Eigen::MatrixXd all(200, 4);
    all << W * scale.cwiseInverse().asDiagonal(), Y / Y.norm();
    const Eigen::VectorXd v = Eigen::JacobiSVD<Eigen::MatrixXd>(all, Eigen::ComputeThinV).matrixV().col(3);
    const Eigen::VectorXd expected = -Y.norm() / v[3] * v.head(3).cwiseQuotient(scale);
    EXPECT_LT((total_least_squares(rows).chi - expected).norm(), 1e-10);
}

TEST(TotalLeastSquares, DoesNotShrinkUnderNoiseOfEveryColumnWhereLeastSquaresDoes) {
    std::mt19937_64 random(4);
    Eigen::Vector2d total = Eigen::Vector2d::Zero(), ordinary = Eigen::Vector2d::Zero();
    constexpr int runs = 50;
    for (int run = 0; run < runs; ++run) {
        observation rows;
        rows.dof = 1;
        rows.n_base = 2;
        observation_block block;
        block.t = Eigen::VectorXd::LinSpaced(400, 0.0, 20.0);
        block.kept = all_rows(1, 400);
        Eigen::MatrixXd W(400, 2);
        W << test::white_noise(400, random), test::white_noise(400, random);
        const Eigen::VectorXd Y = W * Eigen::Vector2d(1.0, 0.0);
        // |Y| is |W_1|: the same relative noise in all three columns.
        Eigen::MatrixXd noisy = W;
        noisy.col(0) += 0.4 * test::white_noise(400, random);
        noisy.col(1) += 0.4 * test::white_noise(400, random);
        block.W = {noisy};
        block.Y = {Y + 0.4 * test::white_noise(400, random)};
        rows.blocks = {block};
        total += total_least_squares(rows).chi / runs;
        ordinary += least_squares(rows, least_squares_method::ols).chi / runs;
    }
    // Attenuation 1 / (1 + 0.16); the mean of 50 runs scatters by 0.005.
    EXPECT_NEAR(ordinary[0], 1.0 / 1.16, 0.02);
    EXPECT_NEAR(total[0], 1.0, 0.02);
}

TEST(TotalLeastSquares, SaysWhichParametersAreNotExcited) {
    observation rows = test::scara_rows();
    for (observation_block& block : rows.blocks) {
        block.W[0].col(1).setZero();
    }
    const estimate fit = total_least_squares(rows);
    EXPECT_EQ(fit.chi.size(), 0);
    EXPECT_EQ(fit.not_excited, std::vector<int>{1});
}

}  // namespace
}  // namespace idim
