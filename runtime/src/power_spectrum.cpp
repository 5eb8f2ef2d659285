#include "idim/power_spectrum.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace idim {

power_spectrum welch_spectrum(const Eigen::Ref<const Eigen::VectorXd>& x, double rate, Eigen::Index segment) {
    if (segment < 2 || segment > x.size()) {
        throw std::invalid_argument("welch_spectrum: segment must be at least 2 and not longer than the signal");
    }
    const auto length = static_cast<double>(segment);
    const Eigen::VectorXd phase =
        Eigen::VectorXd::LinSpaced(segment, 0.0, 2.0 * std::numbers::pi * (length - 1.0) / length);
    const Eigen::VectorXd window = 0.5 - 0.5 * phase.array().cos();
    const Eigen::Index bins = segment / 2 + 1;
    power_spectrum spectrum;
    spectrum.frequency = Eigen::ArrayXd::LinSpaced(bins, 0.0, static_cast<double>(bins - 1)) * (rate / length);
    spectrum.density = Eigen::ArrayXd::Zero(bins);

    Eigen::FFT<double> fft;
    Eigen::VectorXcd transform;
    const Eigen::Index step = segment - segment / 2;
    int segments = 0;
    for (Eigen::Index first = 0; first + segment <= x.size(); first += step, ++segments) {
        const auto part = x.segment(first, segment);
        const Eigen::VectorXd windowed = (part.array() - part.mean()) * window.array();
        fft.fwd(transform, windowed);
        spectrum.density += transform.head(bins).array().abs2();
    }
    spectrum.density *= 2.0 / (rate * window.squaredNorm() * segments);
    spectrum.density[0] *= 0.5;
    if (segment % 2 == 0) {
        spectrum.density[bins - 1] *= 0.5;  // no negative frequency to add at 0 and at rate/2
    }
    return spectrum;
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
