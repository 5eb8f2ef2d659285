#include "idim/multisine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "uniform_numbers.hpp"

namespace idim {

namespace {

constexpr Eigen::Index least_samples = 2000;

/// Phases are drawn for all `count` sinusoids of a joint, so that a narrower band leaves those of other joints alone.
std::vector<double> random_phases(uniform_numbers& uniform, int count) {
    std::vector<double> phases;
    for (int k = 0; k < count; ++k) {
        phases.push_back(2.0 * std::numbers::pi * uniform.next());
    }
    return phases;
}

std::vector<harmonic> equal_sinusoids(int largest_multiple, const std::vector<double>& phases) {
    std::vector<harmonic> terms;
    const int count = std::min(static_cast<int>(phases.size()), largest_multiple);
    for (int k = 1; k <= count; ++k) {
        const double phase = phases[static_cast<std::size_t>(k - 1)];
        const auto multiple = static_cast<int>(std::lround(static_cast<double>(k) * largest_multiple / count));
        terms.push_back({multiple, std::cos(phase), std::sin(phase)});
    }
    return terms;
}

fourier_series one_joint(const fourier_series& series, std::size_t joint) {
    return {series.period, Eigen::VectorXd::Zero(1), {series.joints[joint]}};
}

/// Bound of the largest value of a joint's sum, reached to 3e-5: between instants that are h apart it is at most
/// (w h)^2 / 8 of itself above the largest sampled one, w the highest frequency (Bernstein's inequality twice).
double bound_of(const fourier_series& alone) {
    constexpr int per_sinusoid = 400;
    const Eigen::Index count = per_sinusoid * static_cast<Eigen::Index>(alone.largest_multiple());
    const double wh = 2.0 * std::numbers::pi / per_sinusoid;
    return sample_period(alone, count).q.cwiseAbs().maxCoeff() / (1.0 - wh * wh / 8.0);
}

void scale_by(std::vector<harmonic>& terms, double factor) {
    for (harmonic& term : terms) {
        term.sine *= factor;
        term.cosine *= factor;
    }
}

/// Largest multiple of 1 / period up to the frequency; one that only rounding keeps off counts.
int multiples_below(double frequency, double period) {
    return static_cast<int>(std::floor(frequency * period * (1.0 + 1e-12)));
}

fourier_series in_bands(const motion_limits& limits, const multisine_options& options, const Eigen::VectorXd& band) {
    uniform_numbers uniform(options.seed);
    fourier_series series{options.period, limits.centre(), {}};
    for (Eigen::Index j = 0; j < band.size(); ++j) {
        const std::vector<double> phases = random_phases(uniform, options.count);
        const int largest = multiples_below(band[j], options.period);
        if (largest < 1) {
            throw std::invalid_argument("a period shorter than that of a limit frequency");
        }
        series.joints.push_back(equal_sinusoids(largest, phases));
        const fourier_series alone = one_joint(series, static_cast<std::size_t>(j));
        scale_by(series.joints.back(), limits.half_range()[j] / bound_of(alone));
    }
    return series;
}

/// Largest speed or acceleration of each joint as a share of its limit.
Eigen::VectorXd use_of_limits(const motion_limits& limits, const fourier_series& series) {
    const motion_samples motion = sample_period(series, samples_of_period(series, least_samples));
    const Eigen::VectorXd speed = motion.qd.cwiseAbs().colwise().maxCoeff().transpose();
    const Eigen::VectorXd acceleration = motion.qdd.cwiseAbs().colwise().maxCoeff().transpose();
    return speed.cwiseQuotient(limits.velocity).cwiseMax(acceleration.cwiseQuotient(limits.acceleration));
}

}  // namespace

Eigen::VectorXd limit_frequencies(const motion_limits& limits) {
    return limits.velocity.cwiseQuotient(2.0 * std::numbers::pi * limits.half_range());
}

fourier_series make_multisine(const motion_limits& limits, const multisine_options& options) {
    return in_bands(limits, options, limit_frequencies(limits));
}

fourier_series make_fast_multisine(const motion_limits& limits, const multisine_options& options) {
    constexpr int steps = 8;
    const Eigen::VectorXd published = limit_frequencies(limits);
    Eigen::VectorXd within = published;
    Eigen::VectorXd band = published;
    for (int step = 0; step < steps; ++step) {
        const Eigen::VectorXd use = use_of_limits(limits, in_bands(limits, options, band));
        for (Eigen::Index j = 0; j < band.size(); ++j) {
            if (use[j] <= 1.0) {
                within[j] = std::max(within[j], band[j]);
            }
            band[j] = std::max(published[j], band[j] / use[j]);
        }
    }
    return in_bands(limits, options, within);
}

}  // namespace idim
