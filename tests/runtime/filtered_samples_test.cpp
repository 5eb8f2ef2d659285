#include "idim/filtered_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "idim/input_error.hpp"

namespace idim {
namespace {

const filter_choice published{100.0, 4, 10, ""};

log uniform_log(Eigen::Index samples, double rate) {
    log data;
    data.file = "a.csv";
    data.t = Eigen::ArrayXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)) / rate;
    return data;
}

TEST(FilteredSamples, EdgesOfFivePeriodsOfTheCutoffAreRemoved) {
    log data = uniform_log(1000, 1000.0);
    data.q = data.t;
    data.tau = data.t;
    data.temp = data.t;
    const filtered_samples samples = filter_log(data, published);
    ASSERT_EQ(samples.samples(), 900);  // 50 at each end, as the authors of EMPS do
    EXPECT_NEAR(samples.rate, 1000.0, 1e-9);
    EXPECT_EQ(samples.t, data.t.segment(50, 900));
    EXPECT_EQ(samples.tau, samples.t) << "the torque is not filtered here";
    EXPECT_EQ(samples.temp, samples.t);
    EXPECT_EQ(samples.file, "a.csv");
}

// |H(f)|^2 = 1 + O(f^(2 order)) passes polynomials below degree 2 order, and the differences are exact up to degree 4.
TEST(FilteredSamples, DerivativesOfAPolynomialAreExact) {
    log data = uniform_log(4000, 1000.0);
    const Eigen::ArrayXd t = data.t.array();
    data.q = 0.3 - t + 2.0 * t.square() - 0.5 * t.cube() + 0.1 * t.square().square();
    const filtered_samples samples = filter_log(data, published);
    const Eigen::ArrayXd s = samples.t.array();
    const auto inside = [](const Eigen::ArrayXd& error) {
        return error.segment(300, error.size() - 600).abs().maxCoeff();
    };
    // Rounding of q, 1e-15, times rate (1e3) and rate squared times 5 (stencil); two passes of the filter add a little.
    EXPECT_LT(inside(samples.q.array() - (0.3 - s + 2.0 * s.square() - 0.5 * s.cube() + 0.1 * s.square().square())),
              1e-12);
    EXPECT_LT(inside(samples.qd.array() - (-1.0 + 4.0 * s - 1.5 * s.square() + 0.4 * s.cube())), 1e-10);
    EXPECT_LT(inside(samples.qdd.array() - (4.0 - 3.0 * s + 1.2 * s.square())), 1e-7);
}

TEST(FilteredSamples, SinusoidIsDerivedWithoutPhaseAndWithTheGainSquared) {
    log data = uniform_log(5000, 1000.0);
    for (const double frequency : {5.0, 40.0, 100.0}) {
        const double w = 2.0 * std::numbers::pi * frequency;
        data.q = (w * data.t.array() + 0.4).sin();
        const filtered_samples samples = filter_log(data, published);
        // The analogue filter at the prewarped frequency.
        const double ratio = std::tan(std::numbers::pi * frequency / 1000.0) / std::tan(std::numbers::pi * 0.1);
        const double gain = 1.0 / (1.0 + std::pow(ratio, 8));
        const double x = w / 1000.0;
        const auto inside = [](const Eigen::ArrayXd& error) {
            return error.segment(500, error.size() - 1000).abs().maxCoeff();
        };
        const Eigen::ArrayXd phase = w * samples.t.array() + 0.4;
        EXPECT_LT(inside(samples.q.array() - gain * phase.sin()), 1e-10) << frequency;
        // Truncation of the differences, x^4 / 30 and x^4 / 90 (Abramowitz and Stegun 25.2), plus rounding.
        EXPECT_LT(inside(samples.qd.array() / w - gain * phase.cos()), gain * std::pow(x, 4) / 30.0 + 1e-9)
            << frequency;
        EXPECT_LT(inside(samples.qdd.array() / (w * w) + gain * phase.sin()), gain * std::pow(x, 4) / 90.0 + 1e-8)
            << frequency;
    }
}

TEST(FilteredSamples, JitteredTimeStampsAreResampledFirst) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> spread(-0.4, 0.4);
    log data = uniform_log(5000, 1000.0);
    for (double& t : data.t) {
        t += 1e-3 * spread(random);
    }
    data.q = (6.0 * data.t.array()).sin();
    data.tau = data.q;
    const filtered_samples samples = filter_log(data, {20.0, 4, 1, ""});
    const Eigen::ArrayXd expected = -36.0 * (6.0 * samples.t.array()).sin();
    // Interpolation error below (6 * 1.8e-3)^3 / 24 = 5e-8 (resample_test), white, times (2 pi 20)^2 where the filter
    // ends; and the gain of the filter at 1 Hz, 1 - 20^-8.
    EXPECT_LT((samples.qdd.array() - expected).abs().maxCoeff(), 5e-8 * std::pow(2.0 * std::numbers::pi * 20.0, 2));
    EXPECT_LT((samples.tau - samples.q).cwiseAbs().maxCoeff(), 1e-6) << "torque and position on one grid";
}

std::string error_of_filtering(const log& data, const filter_choice& choice) {
    try {
        filter_log(data, choice);
    } catch (const input_error& caught) {
        return caught.what();
    }
    return "no error";
}

TEST(FilteredSamples, ShortLogIsAnInputErrorThatNamesBothLengths) {
    log data = uniform_log(101, 1000.0);
    data.q = data.t;
    EXPECT_EQ(error_of_filtering(data, published),
              "a.csv: 101 samples (0.1 s) are too few, the filter of order 4 at 100 Hz needs at least 102 (0.101 s)");
    data = uniform_log(102, 1000.0);
    data.q = data.t;
    EXPECT_EQ(error_of_filtering(data, published), "no error");
    data = uniform_log(1, 1.0);
    EXPECT_EQ(error_of_filtering(data, published), "a.csv: t: 1 samples, at least 2 are needed");
}

TEST(FilteredSamples, CutoffAboveTheNyquistFrequencyIsAnInputError) {
    log data = uniform_log(1000, 200.0);
    data.q = data.t;
    EXPECT_EQ(error_of_filtering(data, published),
              "a.csv: cutoff: 100 Hz is not between 0 and half the sampling rate, 100 Hz");
}

}  // namespace
}  // namespace idim
