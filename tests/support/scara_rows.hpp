#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "idim/observation.hpp"
#include "support/noise.hpp"

namespace idim::test {

/// Rows of the 2R SCARA of [IV section 4] with its eight base parameters ZZ1R Fv1 Fc1 ZZ2R LMX2 LMY2 Fv2 Fc2 [IV
/// 52-53], along sums of sinusoids, with the torque of the published parameters and noise of a known kind added.
inline const Eigen::VectorXd& scara_truth() {
    static const Eigen::VectorXd chi =
        (Eigen::VectorXd(8) << 3.44, 0.03, 0.82, 0.062, 0.121, 0.007, 0.013, 0.137).finished();
    return chi;
}

/// Position, velocity and acceleration of a sum of five sinusoids at incommensurate frequencies of 0.08 to 0.9 Hz.
struct motion {
    double q = 0.0;
    double qd = 0.0;
    double qdd = 0.0;
};

inline motion multi_sine(double t, int joint) {
    constexpr double frequency[2][5] = {{0.083, 0.191, 0.337, 0.521, 0.743}, {0.107, 0.239, 0.411, 0.647, 0.893}};
    constexpr double amplitude[5] = {0.9, 0.5, 0.3, 0.2, 0.15};
    motion m;
    for (int h = 0; h < 5; ++h) {
        const double w = 2.0 * std::numbers::pi * frequency[joint][h];
        const double phase = w * t + 1.3 * h + 0.7 * joint;
        m.q += amplitude[h] * std::sin(phase);
        m.qd += amplitude[h] * w * std::cos(phase);
        m.qdd -= amplitude[h] * w * w * std::sin(phase);
    }
    return m;
}

/// Block of noise-free rows at `rate` [Hz] from `start` [s] on along motion_of(t, joint); Y = W chi.
template <typename Motion>
observation_block scara_block(double start, Eigen::Index rows, double rate, const Eigen::VectorXd& chi,
                              Motion motion_of) {
    observation_block block;
    block.file = "scara.csv";
    block.rate = rate;
    block.t = start + Eigen::ArrayXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1) / rate);
    block.kept = all_rows(2, rows);
    block.W.assign(2, Eigen::MatrixXd::Zero(rows, 8));
    for (Eigen::Index k = 0; k < rows; ++k) {
        const motion a = motion_of(block.t[k], 0);
        const motion b = motion_of(block.t[k], 1);
        const double c = std::cos(b.q);
        const double s = std::sin(b.q);
        const double both = 2.0 * a.qdd + b.qdd;
        const double centrifugal = b.qd * (2.0 * a.qd + b.qd);
        const double sum = a.qdd + b.qdd;
        block.W[0].row(k) << a.qdd, a.qd, std::copysign(1.0, a.qd), sum, both * c - centrifugal * s,
            -both * s - centrifugal * c, 0.0, 0.0;
        block.W[1].row(k) << 0.0, 0.0, 0.0, sum, a.qdd * c + a.qd * a.qd * s, a.qd * a.qd * c - a.qdd * s, b.qd,
            std::copysign(1.0, b.qd);
    }
    for (const Eigen::MatrixXd& W : block.W) {
        block.Y.push_back(W * chi);
    }
    return block;
}

inline observation_block scara_block(double start, Eigen::Index rows, double rate, const Eigen::VectorXd& chi) {
    return scara_block(start, rows, rate, chi, multi_sine);
}

/// Leaves out the rows of one joint whose sample `out(k)` names; its rows must be all samples before.
template <typename Rule>
void leave_out(observation_block& block, int joint, Rule out) {
    std::vector<Eigen::Index>& kept = block.kept[joint];
    std::erase_if(kept, out);
    block.W[joint] = Eigen::MatrixXd(block.W[joint](kept, Eigen::all));
    block.Y[joint] = Eigen::VectorXd(block.Y[joint](kept));
}

/// 40 s of rows at 20 Hz, in two blocks of 20 s.
inline observation scara_rows(const Eigen::VectorXd& chi = scara_truth()) {
    observation rows;
    rows.dof = 2;
    rows.n_base = 8;
    rows.blocks = {scara_block(0.0, 400, 20.0, chi), scara_block(100.0, 400, 20.0, chi)};
    return rows;
}

/// One second-order section of a Butterworth low-pass by the bilinear transformation, cut-off as a fraction of the
/// sampling rate, applied forward in time.
inline void low_pass_section(Eigen::VectorXd& x, double cutoff, double quality) {
    const double k = std::tan(std::numbers::pi * cutoff);
    const double a0 = 1.0 + k / quality + k * k;
    const double b0 = k * k / a0;
    const double a1 = 2.0 * (k * k - 1.0) / a0;
    const double a2 = (1.0 - k / quality + k * k) / a0;
    double s1 = 0.0;
    double s2 = 0.0;
    for (double& value : x) {
        const double y = b0 * value + s1;
        s1 = 2.0 * b0 * value - a1 * y + s2;
        s2 = b0 * value - a2 * y;
        value = y;
    }
}

/// White noise at ten times the rate, fourth-order Butterworth forward and backward at 0.8 of the Nyquist frequency of
/// what is kept, one sample in ten: the noise of parallel decimation (METHODS.md, IDIM-LS 3). Unit variance before the
/// filter.
inline Eigen::VectorXd decimated_noise(Eigen::Index n, std::mt19937_64& random) {
    constexpr Eigen::Index factor = 10;
    constexpr Eigen::Index edge = 200;
    Eigen::VectorXd x = white_noise(factor * n + 2 * edge, random);
    for (int direction = 0; direction < 2; ++direction) {
        low_pass_section(x, 0.8 * 0.5 / factor, 0.541196);
        low_pass_section(x, 0.8 * 0.5 / factor, 1.306563);
        x.reverseInPlace();
    }
    Eigen::VectorXd kept(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        kept[k] = x[edge + factor * k];
    }
    return kept;
}

}  // namespace idim::test
