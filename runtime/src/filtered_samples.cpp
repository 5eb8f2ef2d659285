#include "idim/filtered_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "idim/input_error.hpp"
#include "idim/zero_phase_filter.hpp"
#include "motion_filter.hpp"
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

/// Central differences of fourth order over five samples (Abramowitz and Stegun, table 25.2): they lose (2 pi f /
/// f_m)^4 / 30 of qd and / 90 of qdd. The plain ones over three lose (2 pi f / f_m)^2 / 6 of qd and, taken twice, / 3
/// of qdd, which is 2 % of the inertia torque at f_m / 25, the edge of a band decimated by ten.
Eigen::MatrixXd first_derivative(const Eigen::MatrixXd& q, Eigen::Index first, Eigen::Index n, double rate) {
    const auto at = [&](Eigen::Index shift) { return q.middleRows(first + shift, n); };
    return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) * (rate / 12.0);
}

Eigen::MatrixXd second_derivative(const Eigen::MatrixXd& q, Eigen::Index first, Eigen::Index n, double rate) {
    const auto at = [&](Eigen::Index shift) { return q.middleRows(first + shift, n); };
    return (16.0 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30.0 * at(0)) * (rate * rate / 12.0);
}

}  // namespace

filtered_samples filtered_samples::part(Eigen::Index first, Eigen::Index count) const {
    filtered_samples some;
    some.file = file;
    some.rate = rate;
    some.t = t.segment(first, count);
    for (const auto signal : {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd,
                              &filtered_samples::tau, &filtered_samples::temp}) {
        if ((this->*signal).size() > 0) {
            some.*signal = (this->*signal).middleRows(first, count);
        }
    }
    return some;
}

motion_filter::motion_filter(const sampled_span& span, const filter_choice& choice) : rate_(span.rate) {
    if (!(choice.cutoff >= 0.0 && choice.cutoff < 0.5 * rate_)) {
        throw input_error({span.file, 0, "cutoff"},
                          fmt::format("{:.6g} Hz is not between 0 and half the sampling rate, {:.6g} Hz", choice.cutoff,
                                      0.5 * rate_));
    }
    if (choice.cutoff > 0.0) {
        filter_ = butterworth_lowpass(choice.order, choice.cutoff / (0.5 * rate_));
        edge_ = edge_samples(choice.cutoff, rate_);
        reach_ = std::max(settling(filter_), padding(filter_) + 1);
    } else {
        edge_ = difference_reach;
    }
    reach_ = std::max(reach_ + difference_reach, edge_);
    const Eigen::Index needed = std::max(2 * edge_ + 2, choice.cutoff > 0.0 ? padding(filter_) + 1 : 0);
    if (span.samples < needed) {
        throw input_error({span.file, 0, ""},
                          fmt::format("{} samples ({:.3g} s) are too few, the filter of order {} at {:.4g} Hz needs "
                                      "at least {} ({:.3g} s)",
                                      span.samples, static_cast<double>(span.samples - 1) / rate_, choice.order,
                                      choice.cutoff, needed, static_cast<double>(needed - 1) / rate_));
    }
}

filtered_samples motion_filter::apply(const log& uniform, Eigen::Index first, Eigen::Index n) const {
    const Eigen::MatrixXd q = filter_.order > 0 ? zero_phase_filter(filter_, uniform.q) : uniform.q;
    const auto inside = [&](const Eigen::MatrixXd& signal) {
        return signal.size() == 0 ? Eigen::MatrixXd() : Eigen::MatrixXd(signal.middleRows(first, n));
    };
    filtered_samples samples;
    samples.file = uniform.file;
    samples.rate = rate_;
    samples.t = uniform.t.segment(first, n);
    samples.q = inside(q);
    samples.qd = first_derivative(q, first, n, rate_);
    samples.qdd = second_derivative(q, first, n, rate_);
    samples.tau = inside(uniform.tau);
    samples.temp = inside(uniform.temp);
    return samples;
}

void check_decimation(const std::string& file, Eigen::Index samples, const filter_choice& choice) {
    const Eigen::Index needed = choice.decimation > 1 ? padding(decimation_filter(choice.decimation)) + 1 : 0;
    if (samples < needed) {
        throw input_error(
            {file, 0, ""},
            fmt::format("{} samples are left by the filter, the decimation needs at least {}", samples, needed));
    }
}

filtered_samples filter_log(const log& data, const filter_choice& choice) {
    const log uniform = resample_uniform(data);
    const double rate = uniform_rate(uniform.t, {data.file, 0, "t"});
    const motion_filter filter({data.file, uniform.samples(), rate}, choice);
    return filter.apply(uniform, filter.edge(), uniform.samples() - 2 * filter.edge());
}

}  // namespace idim
