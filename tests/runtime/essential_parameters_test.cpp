#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "support/scara_rows.hpp"

namespace idim {
namespace {

/// Columns 8 to 11 of `with_surplus`: slow and fast, none of them in the truth.
const std::vector<int> surplus{8, 9, 10, 11};

/// The rows of the SCARA with four more columns: offset and asymmetric viscous friction of both joints, whose truth is
/// zero.
observation with_surplus() {
    observation rows = test::scara_rows();
    rows.n_base = 12;
    for (observation_block& block : rows.blocks) {
        for (int j = 0; j < 2; ++j) {
            const Eigen::VectorXd qd = block.W[j].col(j == 0 ? 1 : 6);
            block.W[j].conservativeResize(Eigen::NoChange, 12);
            block.W[j].rightCols(4).setZero();
            block.W[j].col(8 + 2 * j).setOnes();
            block.W[j].col(9 + 2 * j) = qd.cwiseAbs();
        }
    }
    return rows;
}

Eigen::VectorXd truth() {
    Eigen::VectorXd chi = Eigen::VectorXd::Zero(12);
    chi.head(8) = test::scara_truth();
    return chi;
}

observation noisy(const observation& clean, unsigned seed) {
    std::mt19937_64 random(seed);
    observation rows = clean;
    for (observation_block& block : rows.blocks) {
        block.Y[0] += 0.1 * test::ar1_noise(block.Y[0].size(), 0.8, random);
        block.Y[1] += 0.005 * test::ar1_noise(block.Y[1].size(), 0.8, random);
    }
    return rows;
}

bool holds_column(const std::vector<int>& list, int column) {
    return std::find(list.begin(), list.end(), column) != list.end();
}

/// Squared residual of the rows, joint j divided by its deviation, with the given columns.
double weighted_residual(const observation& rows, const std::vector<double>& deviation,
                         const std::vector<int>& columns) {
    Eigen::MatrixXd A(rows.rows(), static_cast<Eigen::Index>(columns.size()));
    Eigen::VectorXd y(rows.rows());
    Eigen::Index k = 0;
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < deviation.size(); ++j) {
            A.middleRows(k, block.Y[j].size()) = block.W[j](Eigen::all, columns) / deviation[j];
            y.segment(k, block.Y[j].size()) = block.Y[j] / deviation[j];
            k += block.Y[j].size();
        }
    }
    return (y - A * A.householderQr().solve(y)).squaredNorm();
}

TEST(EssentialParameters, DropsWhatIsNotThereAndKeepsWhatIsCertain) {
    // All four surplus columns go unless their joint test fails, nominally in one run of twenty: of 100 runs at most 5
    // + 3 deviations of 2.2. The same test without regard to the correlation of the residual (F of squared residuals,
    // 1588 degrees of freedom, 5 % above 2.38) would keep some of them in most runs.
    const observation clean = with_surplus();
    int kept_surplus = 0;
    int naive_alarms = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
        const observation rows = noisy(clean, seed);
        const estimate full = least_squares(rows, least_squares_method::wls);
        const essential_parameters found = find_essential(rows, full);
        kept_surplus += std::any_of(surplus.begin(), surplus.end(), [&](int c) { return holds_column(found.kept, c); });
        for (int c = 0; c < 8; ++c) {
            if (full.deviations()[c] < 0.05 * truth()[c]) {
                EXPECT_TRUE(holds_column(found.kept, c)) << "seed " << seed << ", column " << c;
            }
        }
        // The squared residual of joint 1, the larger one, grows by k F (length) / rows at most, 5 * 2.2 * 9 / 800 = 12
        // %; its root by 6 %.
        EXPECT_LT(found.residual.relative_error, 1.06 * full.residual.relative_error);
        EXPECT_GT(found.p_value, 0.05);
        const double all = weighted_residual(rows, full.joint_deviation, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
        const double without = weighted_residual(rows, full.joint_deviation, {0, 1, 2, 3, 4, 5, 6, 7});
        naive_alarms += (without - all) / 4.0 / (all / 1588.0) > 2.38;
    }
    std::printf("surplus kept in %d %% of the runs, naive F test alarms in %d %%\n", kept_surplus, naive_alarms);
    EXPECT_LE(kept_surplus, 11);
    EXPECT_GT(naive_alarms, 40);
}

TEST(EssentialParameters, WithWhiteDeviationsIsTheClassicFTest) {
    const observation rows = noisy(with_surplus(), 3);
    estimate full = least_squares(rows, least_squares_method::wls);
    // Weighted once more with its own deviations, so that chi, weights and covariance belong together as in the classic
    // test.
    const double free_rows = 1600.0 - 12.0;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(12, 12);
    Eigen::VectorXd moment = Eigen::VectorXd::Zero(12);
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < 2; ++j) {
            const double weight = 1.0 / (full.joint_deviation[j] * full.joint_deviation[j]);
            information += weight * block.W[j].transpose() * block.W[j];
            moment += weight * block.W[j].transpose() * block.Y[j];
        }
    }
    std::vector<int> columns{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    const double all = weighted_residual(rows, full.joint_deviation, columns);
    full.chi = information.ldlt().solve(moment);
    full.covariance = all / free_rows * information.inverse();
    full.correlation_length = {1.0, 1.0};

    const essential_parameters found = find_essential(rows, full);
    ASSERT_FALSE(found.dropped.empty());
    const double k = static_cast<double>(found.dropped.size());
    const double without = weighted_residual(rows, full.joint_deviation, found.kept);
    // The oracle goes through normal equations, condition 1e3 squared.
    EXPECT_NEAR(found.f_statistic / ((without - all) / k / (all / free_rows)), 1.0, 1e-6);
}

TEST(EssentialParameters, PValueIsThatOfTheFDistributionOnEffectiveSamples) {
    // One parameter, estimate 1 +- 0.5: F = 4; 122 rows of correlation length 2 leave 61 - 1 = 60 degrees of freedom,
    // and 1 - F(4; 1, 60) = scipy.stats.f.sf(4, 1, 60) = 0.0500330.
    observation rows;
    rows.dof = 1;
    rows.n_base = 1;
    rows.blocks = {{"",
                    1.0,
                    Eigen::VectorXd::Zero(122),
                    all_rows(1, 122),
                    {Eigen::VectorXd::Ones(122)},
                    {Eigen::VectorXd::Ones(122)}}};
    estimate full;
    full.chi = Eigen::VectorXd::Ones(1);
    full.covariance = Eigen::MatrixXd::Constant(1, 1, 0.25);
    full.correlation_length = {2.0};
    full.joint_deviation = {1.0};
    const essential_parameters loose = find_essential(rows, full, 0.0500);
    EXPECT_EQ(loose.dropped, std::vector<int>{0});
    EXPECT_NEAR(loose.f_statistic, 4.0, 1e-14);
    EXPECT_NEAR(loose.p_value, 0.050033, 1e-6);
    EXPECT_EQ(find_essential(rows, full, 0.0501).kept, std::vector<int>{0});
}

TEST(EssentialParameters, OfTheKeptAreTheLeastSquaresSolutionWithoutTheOthers) {
    const observation rows = noisy(with_surplus(), 5);
    const estimate full = least_squares(rows, least_squares_method::wls);
    const essential_parameters found = find_essential(rows, full);
    std::vector<int> together = found.kept;
    together.insert(together.end(), found.dropped.begin(), found.dropped.end());
    std::sort(together.begin(), together.end());
    EXPECT_EQ(together, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
    EXPECT_TRUE(std::is_sorted(found.kept.begin(), found.kept.end()));
    for (const int c : found.dropped) {
        EXPECT_EQ(found.chi[c], 0.0);
        EXPECT_EQ(found.std[c], 0.0);
    }
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(12);
    Eigen::VectorXd size = Eigen::VectorXd::Zero(12);
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Eigen::VectorXd e = (block.Y[j] - block.W[j] * found.chi) / std::pow(full.joint_deviation[j], 2);
            gradient += block.W[j].transpose() * e;
            size += block.W[j].cwiseAbs().transpose() * e.cwiseAbs();
        }
    }
    for (const int c : found.kept) {
        EXPECT_GT(found.std[c], 0.0);
        EXPECT_LT(std::abs(gradient[c]), 1e-10 * size[c]);
    }
    EXPECT_EQ(found.residual.relative_error, errors(rows, found.chi).relative_error);
}

TEST(EssentialParameters, KeepsEverythingThatIsCertain) {
    std::mt19937_64 random(1);
    observation rows = test::scara_rows(Eigen::VectorXd::Ones(8));
    for (observation_block& block : rows.blocks) {
        for (Eigen::VectorXd& Y : block.Y) {
            Y += 0.01 * test::white_noise(Y.size(), random);
        }
    }
    const essential_parameters found = find_essential(rows, least_squares(rows, least_squares_method::ols));
    EXPECT_TRUE(found.dropped.empty());
    EXPECT_EQ(found.f_statistic, 0.0);
    EXPECT_EQ(found.p_value, 1.0);
}

TEST(EssentialParameters, DropsAllWhenThereIsNoTorque) {
    const observation rows = test::scara_rows(Eigen::VectorXd::Zero(8));
    const essential_parameters found = find_essential(rows, least_squares(rows, least_squares_method::wls));
    EXPECT_TRUE(found.kept.empty());
    EXPECT_TRUE(found.chi.isZero(0.0));
    EXPECT_EQ(found.residual.relative_error, 0.0);
}

TEST(EssentialParameters, KeepsWhatIsKnownWithoutAnyDeviation) {
    // A perfect fit: the deviation of every parameter is exactly zero, and so is the second parameter.
    observation rows;
    rows.dof = 1;
    rows.n_base = 2;
    rows.blocks = {{"",
                    1.0,
                    Eigen::VectorXd::Zero(4),
                    all_rows(1, 4),
                    {Eigen::MatrixXd{{1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, 1.0}}},
                    {{}}}};
    rows.blocks[0].Y[0] = Eigen::Vector4d(2.0, 2.0, 0.0, 0.0);
    estimate full = least_squares(rows, least_squares_method::ols);
    full.chi = Eigen::Vector2d(2.0, 0.0);
    full.covariance.setZero();
    const essential_parameters found = find_essential(rows, full);
    EXPECT_EQ(found.kept, std::vector<int>{0});
    EXPECT_EQ(found.dropped, std::vector<int>{1});
    EXPECT_NEAR(found.chi[0], 2.0, 1e-14);
}

TEST(EssentialParameters, NeedAFullModelThatWasIdentified) {
    observation rows = test::scara_rows();
    for (observation_block& block : rows.blocks) {
        block.W[1].col(6).setZero();
    }
    const estimate full = least_squares(rows, least_squares_method::wls);
    EXPECT_THROW(find_essential(rows, full), data_error);
}

}  // namespace
}  // namespace idim
