#include "idim/power_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

namespace idim {
namespace {

// python3: k = numpy.arange(100); x = numpy.sin(0.3*k) + 0.01*k**1.5
//          scipy.signal.welch(x, 50, 'hann', nperseg=24), elements [0, 1, 6, 12] of f and [0, 1, 2, 6, 11, 12] of S,
//          SciPy 1.10.1
TEST(PowerSpectrum, WelchMatchesScipy) {
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(100, 0, 99);
    const Eigen::VectorXd x = (0.3 * k).sin() + 0.01 * k * k.sqrt();
    const power_spectrum spectrum = welch_spectrum(x, 50.0, 24);
    ASSERT_EQ(spectrum.frequency.size(), 13);
    EXPECT_DOUBLE_EQ(spectrum.frequency[1], 2.0833333333333335);
    EXPECT_DOUBLE_EQ(spectrum.frequency[12], 25.0);
    const std::pair<int, double> expected[] = {{0, 0.04263722200578478},     {1, 0.24633710161510347},
                                               {2, 0.06407133672729504},     {6, 2.2820585981077562e-06},
                                               {11, 1.0338289636485533e-08}, {12, 3.8708316462900935e-10}};
    for (const auto& [bin, density] : expected) {
        // The smallest bins are differences of numbers of order one: rounding of 1e-16 on an amplitude of 1e-5.
        EXPECT_NEAR(spectrum.density[bin], density, 1e-9 * density) << bin;
    }
}

TEST(PowerSpectrum, IntegralIsTheVariance) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0.0, 3.0);
    const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(100000, [&]() { return normal(random); });
    for (const Eigen::Index segment : {256, 243}) {
        const power_spectrum spectrum = welch_spectrum(x, 1000.0, segment);
        // 1e5 samples give the variance to sqrt(2 / 1e5) = 0.45 %; the mean of each segment takes another 1 / segment.
        EXPECT_NEAR(spectrum.density.sum() * spectrum.frequency[1], 9.0, 0.02 * 9.0);
    }
}

TEST(PowerSpectrum, EnergyFrequencyIsWhereTheSinusoidStands) {
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(8192, 0, 8191);
    const Eigen::VectorXd x = (2.0 * std::numbers::pi * 10.0 / 1000.0 * k).sin();
    const power_spectrum spectrum = welch_spectrum(x, 1000.0, 2048);
    EXPECT_NEAR(energy_frequency(spectrum, 0.999, 500.0), 10.0,
                2.0 * 1000.0 / 2048.0);  // half the main lobe of the Hann window
    EXPECT_LT(energy_frequency(spectrum, 0.999, 5.0), 5.0) << "energy above the limit does not count";
}

TEST(PowerSpectrum, SegmentIsAtMostAQuarter) {
    EXPECT_EQ(welch_segment(64), 16);
    EXPECT_EQ(welch_segment(100), 24);
    EXPECT_EQ(welch_segment(1000), 192);
    EXPECT_EQ(welch_segment(1 << 20), 1 << 18);
}

TEST(PowerSpectrum, SegmentLongerThanTheSignalIsRefused) {
    EXPECT_THROW(welch_spectrum(Eigen::VectorXd::Zero(10), 1.0, 11), std::invalid_argument);
}

}  // namespace
}  // namespace idim
