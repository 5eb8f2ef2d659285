#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "idim/estimate.hpp"
#include "support/scara_rows.hpp"

namespace idim {
namespace {

using enum least_squares_method;

/// Rows of joints that share the parameters, in one block.
observation stack(const std::vector<Eigen::MatrixXd>& W, const std::vector<Eigen::VectorXd>& Y) {
    observation rows;
    rows.dof = static_cast<int>(W.size());
    rows.n_base = static_cast<int>(W.front().cols());
    observation_block block;
    block.rate = 1.0;
    block.W = W;
    block.Y = Y;
    Eigen::Index samples = 0;
    for (const Eigen::MatrixXd& joint : W) {
        block.kept.push_back(all_rows(1, joint.rows())[0]);
        samples = std::max(samples, joint.rows());
    }
    block.t = Eigen::VectorXd::Zero(samples);
    rows.blocks = {block};
    return rows;
}

observation one_joint_rows(const Eigen::MatrixXd& W, const Eigen::VectorXd& Y) {
    return stack({W}, {Y});
}

/// The rows of the SCARA with white noise of 0.3 and 0.02 N*m.
observation noisy_scara(unsigned seed) {
    std::mt19937_64 random(seed);
    observation rows = test::scara_rows();
    for (observation_block& block : rows.blocks) {
        block.Y[0] += 0.3 * test::white_noise(block.Y[0].size(), random);
        block.Y[1] += 0.02 * test::white_noise(block.Y[1].size(), random);
    }
    return rows;
}

/// All rows, those of joint j multiplied by weight[j], in one matrix whose last column is Y.
Eigen::MatrixXd dense(const observation& rows, const std::vector<double>& weight) {
    Eigen::MatrixXd A(rows.rows(), rows.n_base + 1);
    Eigen::Index k = 0;
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < weight.size(); ++j) {
            const Eigen::Index n = block.Y[j].size();
            A.middleRows(k, n) << weight[j] * block.W[j], weight[j] * block.Y[j];
            k += n;
        }
    }
    return A;
}

Eigen::VectorXd solve_dense(const Eigen::MatrixXd& A) {
    return A.leftCols(A.cols() - 1).colPivHouseholderQr().solve(A.rightCols(1));
}

void expect_failure(const estimate& fit, int rank, const std::vector<int>& not_excited) {
    EXPECT_FALSE(fit.converged);
    EXPECT_EQ(fit.chi.size(), 0);
    EXPECT_EQ(fit.rank, rank);
    EXPECT_EQ(fit.not_excited, not_excited);
    EXPECT_FALSE(fit.message.empty());
    EXPECT_TRUE(std::isfinite(fit.condition_number));
    EXPECT_TRUE(std::isfinite(fit.scaled_condition_number));
    EXPECT_TRUE(std::isfinite(fit.residual.relative_error));
}

void expect_finite(const estimate& fit) {
    EXPECT_TRUE(fit.converged) << fit.message;
    EXPECT_TRUE(fit.chi.allFinite());
    EXPECT_TRUE(fit.covariance.allFinite());
    EXPECT_GE(fit.covariance.diagonal().minCoeff(), 0.0);
    EXPECT_TRUE(fit.std_white.allFinite());
    EXPECT_TRUE(std::isfinite(fit.residual.relative_error));
    EXPECT_TRUE(std::isfinite(fit.condition_number));
    for (std::size_t j = 0; j < fit.joint_deviation.size(); ++j) {
        EXPECT_TRUE(std::isfinite(fit.joint_deviation[j]));
        EXPECT_GE(fit.correlation_length[j], 1.0);
    }
}

/// NIST Statistical Reference Datasets, linear regression, Longley (1967): columns y x1..x6.
Eigen::MatrixXd longley() {
    Eigen::MatrixXd data(16, 7);
    data << 60323, 83.0, 234289, 2356, 1590, 107608, 1947,  //
        61122, 88.5, 259426, 2325, 1456, 108632, 1948,      //
        60171, 88.2, 258054, 3682, 1616, 109773, 1949,      //
        61187, 89.5, 284599, 3351, 1650, 110929, 1950,      //
        63221, 96.2, 328975, 2099, 3099, 112075, 1951,      //
        63639, 98.1, 346999, 1932, 3594, 113270, 1952,      //
        64989, 99.0, 365385, 1870, 3547, 115094, 1953,      //
        63761, 100.0, 363112, 3578, 3350, 116219, 1954,     //
        66019, 101.2, 397469, 2904, 3048, 117388, 1955,     //
        67857, 104.6, 419180, 2822, 2857, 118734, 1956,     //
        68169, 108.4, 442769, 2936, 2798, 120445, 1957,     //
        66513, 110.8, 444546, 4681, 2637, 121950, 1958,     //
        68655, 112.6, 482704, 3813, 2552, 123366, 1959,     //
        69564, 114.2, 502601, 3931, 2514, 125368, 1960,     //
        69331, 115.7, 518173, 4806, 2572, 127852, 1961,     //
        70551, 116.9, 554894, 4007, 2827, 130081, 1962;
    return data;
}

TEST(LeastSquares, ReproducesTheCertifiedLongleyRegression) {
    const Eigen::MatrixXd data = longley();
    Eigen::MatrixXd W(16, 7);
    W << Eigen::VectorXd::Ones(16), data.rightCols(6);
    const estimate fit = least_squares(one_joint_rows(W, data.col(0)), ols);
    Eigen::VectorXd chi(7);
    chi << -3482258.63459582, 15.0618722713733, -0.358191792925910e-01, -2.02022980381683, -1.03322686717359,
        -0.511041056535807e-01, 1829.15146461355;
    Eigen::VectorXd std(7);
    std << 890420.383607373, 84.9149257747669, 0.334910077722432e-01, 0.488399681651699, 0.214274163161675,
        0.226073200069370, 455.478499142212;
    ASSERT_TRUE(fit.converged);
    // Scaled condition 4e4, of the unscaled columns 5e9: rounding costs up to six of sixteen digits.
    EXPECT_LT(((fit.chi - chi).array() / chi.array()).abs().maxCoeff(), 1e-9);
    EXPECT_LT(((fit.std_white - std).array() / std.array()).abs().maxCoeff(), 1e-9);
    EXPECT_NEAR(fit.joint_deviation[0], 304.854073561965, 1e-7);
    // numpy.linalg.cond of the design matrix: 4.85926e9, with columns of norm 1 4.3275e4.
    EXPECT_NEAR(fit.condition_number / 4.85926e9, 1.0, 1e-4);
    EXPECT_NEAR(fit.scaled_condition_number / 4.3275e4, 1.0, 1e-4);
}

TEST(LeastSquares, ReproducesTheCertifiedWamplerPolynomialWithoutResidual) {
    // NIST Wampler1: y = 1 + x + ... + x^5, x = 0..20; all coefficients 1, all deviations 0.
    Eigen::MatrixXd W(21, 6);
    for (int k = 0; k < 21; ++k) {
        for (int p = 0; p < 6; ++p) {
            W(k, p) = std::pow(k, p);
        }
    }
    for (const least_squares_method method : {ols, wls, irls}) {
        const estimate fit = least_squares(one_joint_rows(W, W.rowwise().sum()), method);
        expect_finite(fit);
        EXPECT_LT((fit.chi.array() - 1.0).abs().maxCoeff(), 1e-8);  // unscaled condition 6e6
        EXPECT_LT(fit.residual.relative_error, 1e-14);
        EXPECT_LT(fit.deviations().maxCoeff(), 1e-8);
    }
}

TEST(LeastSquares, OfAConstantIsTheMeanWithItsClassicDeviation) {
    const estimate fit =
        least_squares(one_joint_rows(Eigen::VectorXd::Ones(4), Eigen::Vector4d(1.0, 2.0, 3.0, 6.0)), ols);
    EXPECT_DOUBLE_EQ(fit.chi[0], 3.0);
    EXPECT_NEAR(fit.std_white[0], std::sqrt(14.0 / 3.0 / 4.0), 1e-14);
    EXPECT_NEAR(fit.residual.joints[0].rms, std::sqrt(14.0 / 4.0), 1e-14);
    EXPECT_NEAR(fit.residual.relative_error, std::sqrt(14.0 / 50.0), 1e-14);
    EXPECT_EQ(fit.samples, 4);
}

TEST(LeastSquares, WithoutNoiseGivesTheTruthByEveryMethod) {
    for (const least_squares_method method : {ols, wls, irls}) {
        const estimate fit = least_squares(test::scara_rows(), method);
        expect_finite(fit);
        // Rounding, with up to 1e6 between the weights of the two joints.
        EXPECT_LT((fit.chi - test::scara_truth()).cwiseAbs().maxCoeff(), 1e-10);
        EXPECT_EQ(fit.rank, 8);
    }
}

TEST(LeastSquares, DoesNotDependOnHowTheRowsAreCutIntoBlocks) {
    const observation whole = noisy_scara(1);
    observation cut = whole;
    cut.blocks.clear();
    for (const observation_block& block : whole.blocks) {
        for (const Eigen::Index start : {0, 5, 150}) {  // the first piece has fewer rows than columns
            const Eigen::Index n = start == 0 ? 5 : (start == 5 ? 145 : 250);
            observation_block piece;
            piece.t = block.t.segment(start, n);
            piece.kept = all_rows(2, n);
            for (std::size_t j = 0; j < 2; ++j) {
                piece.W.push_back(block.W[j].middleRows(start, n));
                piece.Y.push_back(block.Y[j].segment(start, n));
            }
            cut.blocks.push_back(piece);
        }
    }
    const estimate one = least_squares(whole, wls);
    const estimate many = least_squares(cut, wls);
    EXPECT_LT((one.chi - many.chi).norm(), 1e-12);
    EXPECT_LT((one.std_white - many.std_white).norm(), 1e-12);
    EXPECT_NEAR(one.scaled_condition_number, many.scaled_condition_number, 1e-9);
}

TEST(LeastSquares, OrdinaryAgreesWithADenseFactorisationOfAllRows) {
    const observation rows = noisy_scara(2);
    EXPECT_LT((least_squares(rows, ols).chi - solve_dense(dense(rows, {1.0, 1.0}))).norm(), 1e-12);
}

TEST(LeastSquares, WeightedDividesEachJointByTheDeviationOfItsOrdinaryError) {
    const observation rows = noisy_scara(3);
    const estimate ordinary = least_squares(rows, ols);
    const estimate fit = least_squares(rows, wls);
    const Eigen::VectorXd expected =
        solve_dense(dense(rows, {1.0 / ordinary.joint_deviation[0], 1.0 / ordinary.joint_deviation[1]}));
    EXPECT_LT((fit.chi - expected).norm(), 1e-12);
    // A deviation from 800 rows is known to 1 / sqrt(1600) = 2.5 %; bound at four of those.
    EXPECT_NEAR(fit.joint_deviation[0], 0.3, 0.03);
    EXPECT_NEAR(fit.joint_deviation[1], 0.02, 0.002);
}

TEST(LeastSquares, JointDeviationIsFreeOfBiasWhenParametersAreMany) {
    // 8 parameters and 2 x 20 rows: dividing by the rows alone would give 0.89 of the variance on average. The mean of
    // 400 variances of 20 rows has a deviation of sqrt(2 / 16 / 400) = 1.8 %; bound at three of those.
    double sum[2] = {0.0, 0.0};
    std::mt19937_64 random(4);
    const observation_block clean = test::scara_block(0.0, 20, 2.0, test::scara_truth());
    for (int run = 0; run < 400; ++run) {
        observation rows = test::scara_rows();
        rows.blocks = {clean};
        rows.blocks[0].Y[0] += test::white_noise(20, random);
        rows.blocks[0].Y[1] += test::white_noise(20, random);
        const estimate fit = least_squares(rows, ols);
        for (int j = 0; j < 2; ++j) {
            sum[j] += fit.joint_deviation[j] * fit.joint_deviation[j] / 400.0;
        }
    }
    EXPECT_NEAR(sum[0], 1.0, 0.055);
    EXPECT_NEAR(sum[1], 1.0, 0.055);
}

TEST(LeastSquares, WeightedIsCloserToTheTruthThanOrdinaryWhenJointsDiffer) {
    double ordinary = 0.0;
    double weighted = 0.0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        const observation rows = noisy_scara(100 + seed);
        ordinary += std::pow(least_squares(rows, ols).chi[3] - test::scara_truth()[3], 2);  // ZZ2R, on both joints
        weighted += std::pow(least_squares(rows, wls).chi[3] - test::scara_truth()[3], 2);
    }
    EXPECT_LT(weighted, 0.2 * ordinary);
}

/// One-sided spikes of 60 deviations on 3 % of the rows.
observation spiked_scara(unsigned seed) {
    observation rows = noisy_scara(seed);
    std::mt19937_64 random(seed);
    std::bernoulli_distribution spike(0.03);
    for (observation_block& block : rows.blocks) {
        for (Eigen::Index k = 0; k < block.t.size(); ++k) {
            block.Y[0][k] += spike(random) ? 18.0 : 0.0;
            block.Y[1][k] += spike(random) ? 1.2 : 0.0;
        }
    }
    return rows;
}

TEST(LeastSquares, ReweightedWithstandsSpikes) {
    double plain = 0.0;
    double robust = 0.0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const observation rows = spiked_scara(seed);
        const estimate fit = least_squares(rows, irls);
        EXPECT_TRUE(fit.converged) << fit.message;
        plain += (least_squares(rows, wls).chi - test::scara_truth()).squaredNorm();
        robust += (fit.chi - test::scara_truth()).squaredNorm();
        // The scale is that of the noise, 3 % of contamination raise a median by 4 %; sampling adds 3 % three times
        // over.
        EXPECT_NEAR(fit.joint_deviation[0], 0.3, 0.04);
    }
    EXPECT_LT(robust, 0.05 * plain);
}

TEST(LeastSquares, ReweightedSolvesTheEquationsOfHubersLoss) {
    const observation rows = spiked_scara(7);
    const estimate fit = least_squares(rows, irls);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(8);
    Eigen::VectorXd size = Eigen::VectorXd::Zero(8);
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Eigen::ArrayXd u = (block.Y[j] - block.W[j] * fit.chi) / fit.joint_deviation[j];
            const Eigen::VectorXd score = u.max(-1.345).min(1.345) / fit.joint_deviation[j];
            sum += block.W[j].transpose() * score;
            size += block.W[j].cwiseAbs().transpose() * score.cwiseAbs();
        }
    }
    // The iteration stops at a relative change of 1e-10.
    EXPECT_LT(sum.cwiseQuotient(size).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(LeastSquares, ReweightedRecordsItsSteps) {
    const observation rows = spiked_scara(8);
    const estimate fit = least_squares(rows, irls);
    ASSERT_GE(fit.iterations.size(), 3U);
    EXPECT_EQ(fit.iterations.front().chi, least_squares(rows, wls).chi);
    EXPECT_EQ(fit.iterations.back().chi, fit.chi);
    EXPECT_EQ(fit.iterations.back().relative_error, fit.residual.relative_error);
}

TEST(LeastSquares, ReweightedLeavesExactRowsAloneWhenAFewAreWrong) {
    // More than half of the residuals are exactly zero: so is the scale, and the two wrong rows do not count.
    Eigen::VectorXd Y = Eigen::VectorXd::Constant(20, 2.0);
    Y[3] = 50.0;
    Y[11] = -7.0;
    const estimate fit = least_squares(one_joint_rows(Eigen::VectorXd::Ones(20), Y), irls);
    expect_finite(fit);
    EXPECT_NEAR(fit.chi[0], 2.0, 1e-3);
}

TEST(LeastSquares, NamesAColumnOfZerosAsNotExcited) {
    observation rows = noisy_scara(9);
    for (observation_block& block : rows.blocks) {
        block.W[1].col(6).setZero();
    }
    for (const least_squares_method method : {ols, wls, irls}) {
        expect_failure(least_squares(rows, method), 7, {6});
    }
}

TEST(LeastSquares, NamesTheColumnsThatDependOnOneAnother) {
    // Along a slow motion in one direction with constant speed, acceleration zero: viscous = Coulomb up to a factor.
    observation rows = noisy_scara(10);
    for (observation_block& block : rows.blocks) {
        block.W[0].col(1) = 1e-3 * block.W[0].col(2);
        block.W[1].col(6) = block.W[1].col(7) + block.W[1].col(5);
        block.W[0].col(6) = block.W[0].col(7) + block.W[0].col(5);
    }
    expect_failure(least_squares(rows, ols), 6, {1, 2, 5, 6, 7});
}

TEST(LeastSquares, JudgesRankByScaledColumnsWhateverTheirUnits) {
    observation rows = noisy_scara(11);
    const estimate before = least_squares(rows, ols);
    for (observation_block& block : rows.blocks) {
        for (Eigen::MatrixXd& W : block.W) {
            W.col(3) *= 1e12;
            W.col(4) *= 1e-9;
        }
    }
    const estimate after = least_squares(rows, ols);
    ASSERT_TRUE(after.converged) << after.message;
    EXPECT_NEAR(after.chi[3] * 1e12 / before.chi[3], 1.0, 1e-9);
    EXPECT_NEAR(after.deviations()[4] * 1e-9 / before.deviations()[4], 1.0, 1e-9);
    EXPECT_NEAR(after.scaled_condition_number, before.scaled_condition_number, 1e-6);
    EXPECT_GT(after.condition_number, 1e3 * before.condition_number);
}

TEST(LeastSquares, WithFewerRowsThanColumnsSaysSo) {
    const estimate fit = least_squares(
        one_joint_rows(Eigen::MatrixXd{{1.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}, Eigen::Vector2d(1.0, 2.0)), wls);
    expect_failure(fit, 2, {0, 2});
}

TEST(LeastSquares, WithAsManyRowsAsColumnsCannotJudgeItsAnswer) {
    const estimate fit = least_squares(one_joint_rows(Eigen::Matrix2d::Identity(), Eigen::Vector2d(1.0, 2.0)), ols);
    expect_failure(fit, 2, {});
    EXPECT_NE(fit.message.find("2 rows for 2 parameters"), std::string::npos) << fit.message;
}

TEST(LeastSquares, WithoutRowsOrParametersExplainsItself) {
    expect_failure(least_squares(one_joint_rows(Eigen::MatrixXd(0, 3), Eigen::VectorXd(0)), irls), 0, {});
    expect_failure(least_squares(one_joint_rows(Eigen::MatrixXd(5, 0), Eigen::VectorXd::Ones(5)), ols), 0, {});
    observation empty;
    empty.dof = 2;
    empty.n_base = 3;
    expect_failure(least_squares(empty, wls), 0, {});
}

TEST(LeastSquares, JointWithoutRowsChangesNothing) {
    std::mt19937_64 random(12);
    Eigen::MatrixXd W(100, 2);
    W << Eigen::VectorXd::Ones(100), Eigen::VectorXd::LinSpaced(100, -1.0, 1.0);
    const Eigen::VectorXd Y = W * Eigen::Vector2d(1.0, -2.0) + 0.1 * test::white_noise(100, random);
    for (const least_squares_method method : {ols, wls, irls}) {
        const estimate alone = least_squares(one_joint_rows(W, Y), method);
        const estimate beside = least_squares(stack({W, Eigen::MatrixXd(0, 2)}, {Y, Eigen::VectorXd(0)}), method);
        expect_finite(beside);
        EXPECT_LT((alone.chi - beside.chi).norm(), 1e-9);  // the IRLS tolerance
        EXPECT_LT((alone.covariance - beside.covariance).norm(), 1e-9 * alone.covariance.norm());
        EXPECT_EQ(beside.joint_deviation[1], 0.0);
        EXPECT_EQ(beside.residual.joints[1].relative_error, 0.0);
    }
}

TEST(LeastSquares, OfTorqueZeroIsZeroWithoutError) {
    observation rows = test::scara_rows();
    for (observation_block& block : rows.blocks) {
        block.Y[0].setZero();
        block.Y[1].setZero();
    }
    for (const least_squares_method method : {ols, wls, irls}) {
        const estimate fit = least_squares(rows, method);
        expect_finite(fit);
        EXPECT_TRUE(fit.chi.isZero(0.0));
        EXPECT_TRUE(fit.deviations().isZero(0.0));
        EXPECT_EQ(fit.residual.relative_error, 0.0);
    }
}

TEST(LeastSquares, RefusesRowsThatAreNotFinite) {
    observation rows = noisy_scara(13);
    rows.blocks[1].Y[0][17] = std::numeric_limits<double>::quiet_NaN();
    expect_failure(least_squares(rows, wls), 0, {});
    rows = noisy_scara(13);
    rows.blocks[0].W[1](3, 7) = std::numeric_limits<double>::infinity();
    expect_failure(least_squares(rows, ols), 0, {});
}

TEST(LeastSquares, StaysFiniteOnAShortLogOfAlmostARandomWalk) {
    // 30 rows, 8 parameters, correlation as long as the log: nothing to trust, but nothing may break either.
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937_64 random(seed);
        observation rows = test::scara_rows();
        rows.blocks = {test::scara_block(0.0, 30, 5.0, test::scara_truth())};
        for (Eigen::VectorXd& Y : rows.blocks[0].Y) {
            Y += 0.3 * test::ar1_noise(30, 0.98, random);
        }
        for (const least_squares_method method : {ols, wls, irls}) {
            expect_finite(least_squares(rows, method));
        }
    }
}

TEST(LeastSquares, RefusesRowsOfTheWrongShape) {
    observation rows = test::scara_rows();
    rows.blocks[0].Y[1].conservativeResize(7);
    EXPECT_THROW(least_squares(rows, ols), std::invalid_argument);
    rows = test::scara_rows();
    rows.blocks[1].W.pop_back();
    EXPECT_THROW(least_squares(rows, ols), std::invalid_argument);
}

TEST(Errors, AreRootMeanSquareAndShareOfTheTorque) {
    const observation rows = stack({Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)},
                                   {Eigen::Vector2d(3.0, 4.0), Eigen::Vector2d(0.0, 12.0)});
    const error_summary summary = errors(rows, Eigen::VectorXd::Constant(1, 3.0));
    EXPECT_NEAR(summary.joints[0].rms, std::sqrt(16.0 / 2.0), 1e-15);
    EXPECT_NEAR(summary.joints[0].relative_error, 4.0 / 5.0, 1e-15);
    EXPECT_NEAR(summary.joints[1].rms, std::sqrt(81.0 / 2.0), 1e-15);
    EXPECT_NEAR(summary.joints[1].relative_error, 9.0 / 12.0, 1e-15);
    EXPECT_NEAR(summary.relative_error, std::sqrt(97.0 / 169.0), 1e-15);
}

TEST(Errors, OfNoTorqueAreZeroForNoResidualAndOneForAny) {
    const observation rows = stack({Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 0.0)},
                                   {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
    const error_summary summary = errors(rows, Eigen::VectorXd::Constant(1, 2.0));
    EXPECT_EQ(summary.joints[0].relative_error, 1.0);
    EXPECT_EQ(summary.joints[1].relative_error, 0.0);
    EXPECT_EQ(summary.relative_error, 1.0);
    EXPECT_EQ(errors(rows, Eigen::VectorXd::Zero(1)).relative_error, 0.0);
}

TEST(Errors, RatioWeighsJointsEachBesideWhatItWas) {
    // The heavy joint loses a hundredth, the light one gains a half: together they lose, on the mean they gain. A joint
    // without residual before counts as unchanged.
    const error_summary before{0.1, {{100.0, 0.1}, {1.0, 0.1}, {0.0, 0.0}}};
    const error_summary after{0.101, {{101.0, 0.101}, {0.5, 0.05}, {0.0, 0.0}}};
    EXPECT_DOUBLE_EQ(error_ratio(before, after), std::sqrt((1.01 * 1.01 + 0.25 + 1.0) / 3.0));
    EXPECT_DOUBLE_EQ(error_ratio(before, before), 1.0);
}

TEST(Errors, RefuseAChiOfTheWrongLength) {
    EXPECT_THROW(errors(test::scara_rows(), Eigen::VectorXd::Zero(7)), std::invalid_argument);
}

}  // namespace
}  // namespace idim
