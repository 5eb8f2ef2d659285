#include "idim/power_spectrum.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace idim {

welch_average::welch_average(double rate, Eigen::Index segment)
    : rate_(rate), power_(Eigen::ArrayXd::Zero(segment / 2 + 1)) {
    const auto length = static_cast<double>(segment);
    const Eigen::VectorXd phase =
        Eigen::VectorXd::LinSpaced(segment, 0.0, 2.0 * std::numbers::pi * (length - 1.0) / length);
    window_ = 0.5 - 0.5 * phase.array().cos();
}

void welch_average::add(const Eigen::Ref<const Eigen::VectorXd>& segment) {
    Eigen::FFT<double> fft;
    Eigen::VectorXcd transform;
    const Eigen::VectorXd windowed = (segment.array() - segment.mean()) * window_.array();
    fft.fwd(transform, windowed);
    power_ += transform.head(power_.size()).array().abs2();
    ++segments_;
}

power_spectrum welch_average::spectrum() const {
    const Eigen::Index bins = power_.size();
    const Eigen::Index segment = window_.size();
    power_spectrum average;
    average.frequency =
        Eigen::ArrayXd::LinSpaced(bins, 0.0, static_cast<double>(bins - 1)) * (rate_ / static_cast<double>(segment));
    average.density = power_ * (2.0 / (rate_ * window_.squaredNorm() * segments_));
    average.density[0] *= 0.5;
    if (segment % 2 == 0) {
        average.density[bins - 1] *= 0.5;  // no negative frequency to add at 0 and at rate/2
    }
    return average;
}

power_spectrum welch_spectrum(const Eigen::Ref<const Eigen::VectorXd>& x, double rate, Eigen::Index segment) {
    if (segment < 2 || segment > x.size()) {
        throw std::invalid_argument("welch_spectrum: segment must be at least 2 and not longer than the signal");
    }
    welch_average average(rate, segment);
    for (Eigen::Index first = 0; first + segment <= x.size(); first += average.step()) {
        average.add(x.segment(first, segment));
    }
    return average.spectrum();
}

Eigen::Index welch_segment(Eigen::Index samples) {
    Eigen::Index power = 1;
    while (2 * power <= samples / 4) {
        power *= 2;
    }
    return power / 2 * 3 <= samples / 4 ? power / 2 * 3 : power;
}

double energy_frequency(const power_spectrum& spectrum, double share, double limit) {
    const auto inside = (spectrum.frequency <= limit).select(spectrum.density, 0.0).eval();
    const double wanted = share * inside.sum();
    double energy = 0.0;
    for (Eigen::Index k = 0; k < inside.size(); ++k) {
        energy += inside[k];
        if (energy >= wanted) {
            return spectrum.frequency[k];
        }
    }
    return limit;
}

}  // namespace idim
