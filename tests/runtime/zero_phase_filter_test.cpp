#include "idim/zero_phase_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace idim {
namespace {

using row_major_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// x = numpy.sin(0.3 * k) + 0.01 * k**1.5, k = numpy.arange(60)
Eigen::VectorXd bent_sine() {
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(60, 0, 59);
    return (0.3 * k).sin() + 0.01 * k * k.sqrt();
}

void expect_values(const Eigen::MatrixXd& x, const std::vector<int>& rows, const std::vector<double>& expected,
                   double tolerance) {
    for (size_t k = 0; k < rows.size(); ++k) {
        EXPECT_NEAR(x(rows[k], 0), expected[k], tolerance) << "row " << rows[k];
    }
}

// python3: scipy.signal.sosfiltfilt(scipy.signal.butter(order, cutoff, output='sos'), x)[[0, 1, 17, 30, 58, 59]],
// SciPy 1.10.1. SciPy's own filtfilt on the polynomial form differs from these by up to 7e-12 (order 5), so 1e-11 is
// rounding.
TEST(ZeroPhaseFilter, ZeroPhaseFilterMatchesScipy) {
    const std::vector<int> rows = {0, 1, 17, 30, 58, 59};
    const Eigen::VectorXd x = bent_sine();
    expect_values(zero_phase_filter(butterworth_lowpass(1, 0.2), x), rows,
                  {-0.0017235584295958173, 0.2595329536683231, -0.05587266239450497, 1.9852289223472386,
                   3.521378730080746, 3.6229725478002},
                  1e-11);
    expect_values(zero_phase_filter(butterworth_lowpass(4, 0.2), x), rows,
                  {0.0003488658302014877, 0.311566304613325, -0.22307148847849503, 2.0542387022146484,
                   3.4911744487969334, 3.626031762210152},
                  1e-11);
    expect_values(zero_phase_filter(butterworth_lowpass(5, 0.05), x), rows,
                  {-0.08808035908598734, -0.05715292019529622, 0.684057925886395, 1.6578531003995047, 3.775477466576383,
                   3.792881576907655},
                  1e-11);
    expect_values(zero_phase_filter(butterworth_lowpass(12, 0.3), x), rows,
                  {0.0003665032962342288, 0.3084805373038445, -0.2251532456521479, 2.055086361667174,
                   3.4485007899893514, 3.618370000477248},
                  1e-11);
}

// python3: k = numpy.arange(2000); x = numpy.sin(0.01*k) + 0.3*numpy.sin(0.2*k) + 1e-3*k
//          scipy.signal.decimate(x, 10, ftype='iir', zero_phase=True)[[0, 1, 50, 100, 198, 199]], and (x, 100)[[0, 1,
//          10, 11, 18, 19]]
// By 100 the poles lie 2e-2 from z = 1 and the eight recursions amplify the rounding of the coefficients: 1e-9 there.
TEST(ZeroPhaseFilter, DecimationMatchesScipy) {
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(2000, 0, 1999);
    const Eigen::VectorXd x = (0.01 * k).sin() + 0.3 * (0.2 * k).sin() + 1e-3 * k;
    const Eigen::MatrixXd by_10 = decimate(x, 10);
    ASSERT_EQ(by_10.rows(), 200);
    expect_values(by_10, {0, 1, 50, 100, 198, 199},
                  {-0.017557822975253858, 0.387958467034518, -0.606214997549686, 0.18889863353453168,
                   2.8348748514022626, 3.0156680109316563},
                  1e-11);
    const Eigen::MatrixXd by_100 = decimate(x, 100);
    ASSERT_EQ(by_100.rows(), 20);
    expect_values(by_100, {0, 1, 10, 11, 18, 19},
                  {0.09123647108633708, 0.901151344635814, 0.45233477972652464, 0.09216195755393636, 0.8536578698442663,
                   0.8768337123597695},
                  1e-9);
}

TEST(ZeroPhaseFilter, SinusoidKeepsItsPhaseAndIsScaledByTheGainSquared) {
    const second_order_sections filter = butterworth_lowpass(4, 0.05);
    for (const double frequency : {0.01, 0.05, 0.1}) {  // of the Nyquist frequency
        const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(4001, 0, 4000);
        const Eigen::ArrayXd x = (std::numbers::pi * frequency * k + 0.7).sin();
        const Eigen::ArrayXd y = zero_phase_filter(filter, x.matrix());
        const double squared = std::pow(filter.gain(frequency), 2);
        // The slowest pole decays by 0.94 a sample: 1000 samples from the ends nothing of them is left.
        EXPECT_LT((y - squared * x).segment(1000, 2001).abs().maxCoeff(), 1e-12) << frequency;
    }
}

TEST(ZeroPhaseFilter, StraightLinePassesUnchangedUpToTheEnds) {
    const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(500, -3.0, 7.0);
    // Odd reflection continues a line as the same line, but the steady state at its ends is that of a constant: what is
    // left is the transient of the slope after the padding, hence the short filter.
    const Eigen::VectorXd filtered = zero_phase_filter(butterworth_lowpass(2, 0.5), line);
    EXPECT_LT((filtered - line).cwiseAbs().maxCoeff(), 1e-3 * 0.02);
    EXPECT_LT((filtered - line).segment(50, 400).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ZeroPhaseFilter, ConstantPassesUnchangedUpToTheEnds) {
    const Eigen::VectorXd constant = Eigen::VectorXd::Constant(300, 4.2);
    EXPECT_LT((zero_phase_filter(butterworth_lowpass(7, 0.01), constant) - constant).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ZeroPhaseFilter, ColumnsDoNotTouchEachOtherWhateverTheStorage) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd x = Eigen::MatrixXd::NullaryExpr(200, 19, [&]() { return normal(random); });
    x.col(3).setZero();
    const second_order_sections filter = butterworth_lowpass(3, 0.2);
    const Eigen::MatrixXd together = zero_phase_filter(filter, x);
    const row_major_matrix transposed_storage = x;
    EXPECT_EQ(zero_phase_filter(filter, transposed_storage), together);
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
        EXPECT_EQ(zero_phase_filter(filter, x.col(column)), together.col(column)) << column;
    }
    EXPECT_TRUE((together.col(3).array() == 0.0).all());
}

TEST(ZeroPhaseFilter, StrideKeepsRowsOfTheFullResult) {
    const Eigen::VectorXd x = bent_sine();
    const second_order_sections filter = butterworth_lowpass(4, 0.3);
    const Eigen::MatrixXd all = zero_phase_filter(filter, x);
    const Eigen::MatrixXd kept = zero_phase_filter(filter, x, 7);
    ASSERT_EQ(kept.rows(), 9);
    for (Eigen::Index row = 0; row < kept.rows(); ++row) {
        EXPECT_EQ(kept(row, 0), all(7 * row, 0));
    }
}

TEST(ZeroPhaseFilter, DecimationByOneChangesNothing) {
    const Eigen::VectorXd x = bent_sine();
    EXPECT_EQ(decimate(x, 1), x);
}

TEST(ZeroPhaseFilter, SignalMustBeLongerThanThePadding) {
    const second_order_sections filter = butterworth_lowpass(4, 0.3);
    EXPECT_EQ(padding(filter), 15);
    EXPECT_THROW(zero_phase_filter(filter, Eigen::VectorXd::Zero(15)), std::invalid_argument);
    EXPECT_NO_THROW(zero_phase_filter(filter, Eigen::VectorXd::Zero(16)));
}

}  // namespace
}  // namespace idim
