#include "idim/filtered_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "idim/input_error.hpp"
#include "idim/zero_phase_filter.hpp"
#include "uniform_time.hpp"

namespace idim {
namespace {

/// Samples dropped at each end, five periods of the cut-off: the authors of the EMPS record drop 50 at 1 kHz for 100 Hz
/// (data/emps/README.md). At least ten, for a cut-off is below half the rate, so the differences need no edge case.
Eigen::Index edge_samples(double cutoff, double rate) {
    return static_cast<Eigen::Index>(std::ceil(5.0 * rate / cutoff - 1e-9));
}

/// Samples that the differences reach to each side, all that is lost without a filter.
constexpr Eigen::Index difference_reach = 2;

void check_length(const log& data, const filter_choice& choice, double rate, Eigen::Index edge, Eigen::Index pad) {
    const Eigen::Index needed = std::max(2 * edge + 2, pad + 1);
    if (data.samples() < needed) {
        throw input_error({data.file, 0, ""},
                          fmt::format("{} samples ({:.3g} s) are too few, the filter of order {} at {:.4g} Hz needs "
                                      "at least {} ({:.3g} s)",
                                      data.samples(), data.duration(), choice.order, choice.cutoff, needed,
                                      static_cast<double>(needed - 1) / rate));
    }
}

/// Central differences of fourth order over five samples (Abramowitz and Stegun, table 25.2): they lose (2 pi f /
/// f_m)^4 / 30 of qd and / 90 of qdd. The plain ones over three lose (2 pi f / f_m)^2 / 6 of qd and, taken twice, / 3
/// of qdd, which is 2 % of the inertia torque at f_m / 25, the edge of a band decimated by ten.
Eigen::MatrixXd first_derivative(const Eigen::MatrixXd& q, Eigen::Index edge, double rate) {
    const Eigen::Index n = q.rows() - 2 * edge;
    const auto at = [&](Eigen::Index shift) { return q.middleRows(edge + shift, n); };
    return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) * (rate / 12.0);
}

Eigen::MatrixXd second_derivative(const Eigen::MatrixXd& q, Eigen::Index edge, double rate) {
    const Eigen::Index n = q.rows() - 2 * edge;
    const auto at = [&](Eigen::Index shift) { return q.middleRows(edge + shift, n); };
    return (16.0 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30.0 * at(0)) * (rate * rate / 12.0);
}

}  // namespace

filtered_samples filter_log(const log& data, const filter_choice& choice) {
    const log uniform = resample_uniform(data);
    const double rate = uniform_rate(uniform.t, {data.file, 0, "t"});
    if (!(choice.cutoff >= 0.0 && choice.cutoff < 0.5 * rate)) {
        throw input_error(
            {data.file, 0, "cutoff"},
            fmt::format("{:.6g} Hz is not between 0 and half the sampling rate, {:.6g} Hz", choice.cutoff, 0.5 * rate));
    }
    const bool filters = choice.cutoff > 0.0;
    const second_order_sections filter =
        filters ? butterworth_lowpass(choice.order, choice.cutoff / (0.5 * rate)) : second_order_sections();
    const Eigen::Index edge = filters ? edge_samples(choice.cutoff, rate) : difference_reach;
    check_length(uniform, choice, rate, edge, filters ? padding(filter) : 0);
    const Eigen::MatrixXd q = filters ? zero_phase_filter(filter, uniform.q) : uniform.q;
    const Eigen::Index n = q.rows() - 2 * edge;
    const auto inside = [&](const Eigen::MatrixXd& signal) {
        return signal.size() == 0 ? Eigen::MatrixXd() : Eigen::MatrixXd(signal.middleRows(edge, n));
    };

    filtered_samples samples;
    samples.file = data.file;
    samples.rate = rate;
    samples.t = uniform.t.segment(edge, n);
    samples.q = inside(q);
    samples.qd = first_derivative(q, edge, rate);
    samples.qdd = second_derivative(q, edge, rate);
    samples.tau = inside(uniform.tau);
    samples.temp = inside(uniform.temp);
    return samples;
}

}  // namespace idim
