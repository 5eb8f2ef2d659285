#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "idim/filtered_samples.hpp"

namespace idim {
namespace {

/// Times 0..duration with steps spread by `jitter` of a period around 1/rate.
Eigen::VectorXd jittered_times(double rate, double duration, double jitter) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> spread(-0.5 * jitter, 0.5 * jitter);
    const auto samples = static_cast<Eigen::Index>(duration * rate) + 1;
    return Eigen::VectorXd::NullaryExpr(
        samples, [&](Eigen::Index k) { return (static_cast<double>(k) + spread(random)) / rate; });
}

TEST(Resample, UniformLogIsReturnedAsItIs) {
    log data;
    data.file = "a.csv";
    data.t = Eigen::VectorXd::LinSpaced(1000, 5.0, 5.999);
    data.q = Eigen::MatrixXd::Random(1000, 2);
    const log same = resample_uniform(data);
    EXPECT_EQ(same.t, data.t);
    EXPECT_EQ(same.q, data.q);
    EXPECT_EQ(same.file, "a.csv");
}

TEST(Resample, GridHasTheMedianPeriodAndStaysInsideTheLog) {
    log data;
    data.t = Eigen::VectorXd::LinSpaced(101, 2.0, 3.0);
    data.t[50] += 0.004;                                  // a late row
    data.t.tail(20) += Eigen::VectorXd::Constant(20, 1);  // a pause
    data.q = data.t;
    const log uniform = resample_uniform(data);
    EXPECT_EQ(uniform.t[0], 2.0);
    EXPECT_NEAR(uniform.t[1] - uniform.t[0], 0.01, 1e-12);
    EXPECT_EQ(uniform.samples(), 201);
    EXPECT_LE(uniform.t[200], data.t[100] + 1e-9);
    EXPECT_LT((uniform.q - uniform.t).cwiseAbs().maxCoeff(), 1e-12) << "a straight line comes back exactly";
}

TEST(Resample, ParabolaComesBackExactlyInside) {
    log data;
    data.t = jittered_times(100.0, 2.0, 0.8);
    data.q = data.t.array().square();
    const log uniform = resample_uniform(data);
    const Eigen::ArrayXd error = uniform.q.array() - uniform.t.array().square();
    // Slopes are exact but for the two end samples, where the chord of one period stands in.
    EXPECT_LT(error.segment(3, error.size() - 6).abs().maxCoeff(), 1e-12);
    EXPECT_LT(error.abs().maxCoeff(), 0.01 * 0.01);
}

TEST(Resample, SinusoidComesBackToThirdOrder) {
    for (const double rate : {100.0, 200.0, 400.0}) {
        log data;
        data.t = jittered_times(rate, 3.0, 0.8);
        data.q = (6.0 * data.t.array()).sin();
        const log uniform = resample_uniform(data);
        const Eigen::ArrayXd error = uniform.q.array() - (6.0 * uniform.t.array()).sin();
        // Slope error q''' h1 h2 / 6 times at most h / 4, steps up to 1.8 periods: (6 * 1.8 / rate)^3 / 24.
        EXPECT_LT(error.segment(3, error.size() - 6).abs().maxCoeff(), std::pow(6.0 * 1.8 / rate, 3) / 24.0) << rate;
    }
}

TEST(Resample, EverySignalIsResampledAndWhatIsNotThereStaysEmpty) {
    log data;
    data.t = jittered_times(50.0, 1.0, 0.5);
    for (const auto signal : {&log::q, &log::tau, &log::v, &log::qr, &log::qd, &log::temp}) {
        data.*signal = 2.0 * data.t;
    }
    const log uniform = resample_uniform(data);
    for (const auto signal : {&log::q, &log::tau, &log::v, &log::qr, &log::qd, &log::temp}) {
        EXPECT_LT((uniform.*signal - 2.0 * uniform.t).cwiseAbs().maxCoeff(), 1e-12);
    }
    EXPECT_EQ(uniform.qdd.size(), 0);
}

}  // namespace
}  // namespace idim
