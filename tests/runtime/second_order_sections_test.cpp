#include "idim/second_order_sections.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace idim {
namespace {

constexpr std::array frequencies = {0.01, 0.1, 0.2, 0.3, 0.7};
using gains = std::array<double, frequencies.size()>;

// Both sides evaluate a product of sections in double; far in the stop band the smallest gain here, 1e-11, has lost
// five digits in 1 + z^-1 near z = -1.
constexpr double gain_rounding = 1e-10;

void expect_gains(const second_order_sections& filter, const gains& expected) {
    for (size_t k = 0; k < frequencies.size(); ++k) {
        EXPECT_NEAR(filter.gain(frequencies[k]), expected[k], gain_rounding * expected[k]) << frequencies[k];
    }
}

// python3: abs(scipy.signal.sosfreqz(scipy.signal.butter(order, cutoff, output='sos'),
//              numpy.pi * numpy.array([0.01, 0.1, 0.2, 0.3, 0.7]))[1]), SciPy 1.10.1
TEST(SecondOrderSections, ButterworthMatchesScipy) {
    expect_gains(butterworth_lowpass(1, 0.2),
                 {0.9988332748682321, 0.8988915633764919, 0.7071067811865476, 0.5376717258349769, 0.16333165443318406});
    expect_gains(butterworth_lowpass(3, 0.2), {0.9999999936137284, 0.9933588135581033, 0.7071067811865471,
                                               0.25101425117298837, 0.004537548572552277});
    expect_gains(butterworth_lowpass(4, 0.1), {0.9999999953171016, 0.7071067811865471, 0.05637087561896157,
                                               0.009336145381285861, 4.241442462293877e-05});
    expect_gains(butterworth_lowpass(12, 0.3), {1.0000000000000002, 0.9999999999996686, 0.9999897763227612,
                                                0.7071067811865456, 9.37521289978259e-08});
}

// python3: the same with scipy.signal.cheby1(8, 0.05, 0.08, output='sos') and cheby1(5, 0.5, 0.2, output='sos')
TEST(SecondOrderSections, ChebyshevMatchesScipy) {
    expect_gains(chebyshev_lowpass(8, 0.05, 0.08), {0.9983004333570655, 0.06960211618090446, 5.2265168523278335e-05,
                                                    1.1757698226439753e-06, 2.1573086555716506e-11});
    expect_gains(chebyshev_lowpass(5, 0.5, 0.2), {0.9965192071413422, 0.9813283804116613, 0.9440608762859231,
                                                  0.03470286415797832, 2.3036224762581113e-05});
}

// |H|^2 = 1 / (1 + (tan(pi f / 2) / tan(pi c / 2))^(2 order)), the analogue filter at the prewarped frequency.
TEST(SecondOrderSections, ButterworthHasItsClosedFormGainAtEveryOrder) {
    const auto warp = [](double f) { return std::tan(0.5 * std::numbers::pi * f); };
    for (int order = 1; order <= 12; ++order) {
        for (const double cutoff : {1e-3, 0.02, 0.4, 0.9}) {
            const second_order_sections filter = butterworth_lowpass(order, cutoff);
            EXPECT_EQ(filter.sections.size(), (order + 1u) / 2u);
            for (const double f : {0.3 * cutoff, 0.9 * cutoff, cutoff, 1.07 * cutoff}) {
                const double expected = 1.0 / std::sqrt(1.0 + std::pow(warp(f) / warp(cutoff), 2 * order));
                // At a cut-off of 1e-3 the poles lie 3e-3 from z = 1, whose squares lose five of sixteen digits.
                EXPECT_NEAR(filter.gain(f), expected, 1e-8) << order << " " << cutoff << " " << f;
            }
        }
    }
}

// |H|^2 = 1 / (1 + epsilon^2 T_n^2(tan(pi f / 2) / tan(pi c / 2))), T_n(x) = cos(n acos x) within the pass band.
TEST(SecondOrderSections, ChebyshevHasItsClosedFormRipple) {
    const auto warp = [](double f) { return std::tan(0.5 * std::numbers::pi * f); };
    const double epsilon_squared = std::pow(10.0, 0.005) - 1.0;
    for (const int decimation : {2, 10, 100, 500}) {
        const double cutoff = 0.8 / decimation;
        const second_order_sections filter = chebyshev_lowpass(8, 0.05, cutoff);
        for (double share = 0.0; share <= 1.0; share += 0.05) {
            const double polynomial = std::cos(8.0 * std::acos(std::min(1.0, warp(share * cutoff) / warp(cutoff))));
            const double expected = 1.0 / std::sqrt(1.0 + epsilon_squared * polynomial * polynomial);
            EXPECT_NEAR(filter.gain(share * cutoff), expected, 1e-8) << decimation << " " << share;
        }
    }
}

TEST(SecondOrderSections, ConstantPassesUnchangedHoweverNarrowTheBand) {
    for (int order = 1; order <= 12; ++order) {
        // The gain at 0 is set from the rounded coefficients: only the last digit of each section is left.
        EXPECT_NEAR(butterworth_lowpass(order, 1e-4).gain(0.0), 1.0, 1e-14) << order;
    }
}

TEST(SecondOrderSections, WrongOrderOrCutoffIsRefused) {
    EXPECT_THROW(butterworth_lowpass(0, 0.1), std::invalid_argument);
    EXPECT_THROW(butterworth_lowpass(13, 0.1), std::invalid_argument);
    EXPECT_THROW(butterworth_lowpass(4, 0.0), std::invalid_argument);
    EXPECT_THROW(butterworth_lowpass(4, 1.0), std::invalid_argument);
    EXPECT_THROW(chebyshev_lowpass(8, 0.0, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace idim
