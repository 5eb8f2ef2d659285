#include "idim/fourier_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace idim {

int fourier_series::largest_multiple() const {
    int largest = 1;
    for (const std::vector<harmonic>& joint : joints) {
        for (const harmonic& term : joint) {
            largest = std::max(largest, term.multiple);
        }
    }
    return largest;
}

motion_samples sample_period(const fourier_series& series, Eigen::Index count) {
    const Eigen::ArrayXd turn = Eigen::ArrayXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)) *
                                (2.0 * std::numbers::pi / static_cast<double>(count));
    const Eigen::ArrayXd sines = turn.sin();
    const Eigen::ArrayXd cosines = turn.cos();
    const auto n = static_cast<Eigen::Index>(series.joints.size());
    motion_samples samples;
    samples.t = turn.matrix() * (series.period / (2.0 * std::numbers::pi));
    samples.q = series.offset.transpose().replicate(count, 1);
    samples.qd = Eigen::MatrixXd::Zero(count, n);
    samples.qdd = Eigen::MatrixXd::Zero(count, n);
    for (Eigen::Index j = 0; j < n; ++j) {
        for (const harmonic& term : series.joints[static_cast<std::size_t>(j)]) {
            const double w = 2.0 * std::numbers::pi * term.multiple / series.period;
            // Of sample k the angle is turn[m k mod count]: exactly periodic, and no sine is computed twice.
            Eigen::Index at = 0;
            for (Eigen::Index k = 0; k < count; ++k) {
                const double value = term.sine * sines[at] + term.cosine * cosines[at];
                samples.q(k, j) += value;
                samples.qd(k, j) += w * (term.sine * cosines[at] - term.cosine * sines[at]);
                samples.qdd(k, j) -= w * w * value;
                at = (at + term.multiple) % count;
            }
        }
    }
    return samples;
}

Eigen::Index samples_of_period(const fourier_series& series, Eigen::Index least) {
    return std::max<Eigen::Index>(least, 40 * static_cast<Eigen::Index>(series.largest_multiple()));
}

}  // namespace idim
