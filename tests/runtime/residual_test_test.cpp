#include "idim/residual_test.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/scara_rows.hpp"

namespace idim {
namespace {

/// Part of 100 runs in which p stays below 0.05, of whiteness and of normality, over both joints.
struct rejections {
    double whiteness = 0.0;
    double normality = 0.0;
};

template <typename Noise>
rejections reject(Noise noise) {
    constexpr int runs = 100;
    std::mt19937_64 random(9);
    rejections result;
    for (int run = 0; run < runs; ++run) {
        observation rows = test::scara_rows();
        for (observation_block& block : rows.blocks) {
            for (int j = 0; j < 2; ++j) {
                block.Y[j] += 0.1 * noise(block.Y[j].size(), random);
            }
        }
        const estimate fit = least_squares(rows, least_squares_method::wls);
        for (const residual_test& test : test_residual(rows, fit)) {
            result.whiteness += test.whiteness_p.value() < 0.05 ? 0.5 / runs : 0.0;
            result.normality += test.normality_p.value() < 0.05 ? 0.5 / runs : 0.0;
        }
    }
    return result;
}

TEST(ResidualTest, RejectsWhiteNormalNoiseAtItsLevel) {
    const rejections rate = reject(test::white_noise);
    // 200 tests at 5 %: deviation 1.5 %; Jarque and Bera reject less than that in short series.
    EXPECT_LT(rate.whiteness, 0.11);
    EXPECT_LT(rate.normality, 0.10);
}

TEST(ResidualTest, SeesCorrelationAndStillJudgesNormality) {
    const rejections rate =
        reject([](Eigen::Index n, std::mt19937_64& random) { return test::ar1_noise(n, 0.7, random); });
    EXPECT_GT(rate.whiteness, 0.99);
    EXPECT_LT(rate.normality, 0.12);
}

TEST(ResidualTest, SeesHeavyTails) {
    const rejections rate = reject([](Eigen::Index n, std::mt19937_64& random) {
        return Eigen::VectorXd(test::white_noise(n, random).array().cube());
    });
    EXPECT_GT(rate.normality, 0.99);
}

}  // namespace
}  // namespace idim
