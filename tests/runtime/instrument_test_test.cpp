#include "idim/instrument_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/scara_rows.hpp"

namespace idim {
namespace {

/// Rows with the measured regressor equal to the clean one plus noise, `shared` of which is in the torque error too.
struct noisy_rows {
    observation measured, clean;
};

noisy_rows draw_rows(double shared, std::mt19937_64& random) {
    noisy_rows rows{test::scara_rows(), test::scara_rows()};
    for (observation_block& block : rows.measured.blocks) {
        for (int j = 0; j < 2; ++j) {
            for (Eigen::Index c = 0; c < 8; ++c) {
                if (block.W[j].col(c).isZero()) {
                    continue;
                }
                const Eigen::VectorXd noise = 0.2 * test::white_noise(block.Y[j].size(), random);
                block.Y[j] += shared * noise;
                // Independent of the torque error as measured: the torque follows the regressor that was recorded.
                block.Y[j] += noise * test::scara_truth()[c];
                block.W[j].col(c) += noise;
            }
            block.Y[j] += 0.1 * test::white_noise(block.Y[j].size(), random);
        }
    }
    return rows;
}

double rejected(double shared) {
    constexpr int runs = 60;
    std::mt19937_64 random(12);
    double part = 0.0;
    for (int run = 0; run < runs; ++run) {
        const noisy_rows rows = draw_rows(shared, random);
        const estimate fit = least_squares(rows.measured, least_squares_method::wls);
        part += durbin_wu_hausman(rows.measured, rows.clean, fit, fit).p_value < 0.05 ? 1.0 / runs : 0.0;
    }
    return part;
}

TEST(DurbinWuHausman, RejectsAnUncorrelatedRegressorAtItsLevel) {
    // 60 tests at 5 %: deviation 2.8 %; three of them.
    EXPECT_LT(rejected(0.0), 0.14);
}

TEST(DurbinWuHausman, SeesARegressorThatSharesItsNoiseWithTheTorque) {
    EXPECT_GT(rejected(0.5), 0.95);
}

TEST(DurbinWuHausman, GivesTheBiasInPercentAndDeviations) {
    std::mt19937_64 random(1);
    const noisy_rows rows = draw_rows(0.0, random);
    const estimate iv = least_squares(rows.measured, least_squares_method::wls);
    estimate ls = iv;
    ls.chi[0] = 0.9 * iv.chi[0];
    const instrument_test test = durbin_wu_hausman(rows.measured, rows.clean, ls, iv);
    EXPECT_NEAR(test.bias_percent[0], -10.0, 1e-9);
    EXPECT_NEAR(test.bias_in_deviations[0], -0.1 * iv.chi[0] / iv.deviations()[0], 1e-9);
    EXPECT_NEAR(test.bias_percent[1], 0.0, 1e-9);
}

}  // namespace
}  // namespace idim
