#pragma once

#include <Eigen/Core>
#include <cmath>

namespace idim::test {

/// Rows of a log made for the tracer, 30 s of them.
inline constexpr Eigen::Index rows_in_log = 600;
inline constexpr double row_rate = 20.0;  // Hz

/// A sine of the rows' time [s] of this frequency [Hz].
inline Eigen::VectorXd sine(double frequency, double phase = 0.0) {
    const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(rows_in_log, 0.0, (rows_in_log - 1) / row_rate);
    return (2.0 * M_PI * frequency * t + phase).sin().matrix();
}

}  // namespace idim::test
