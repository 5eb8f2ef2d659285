#include "noise_floor.hpp"

#include <algorithm>
#include <cmath>

#include "idim/power_spectrum.hpp"

namespace idim {

namespace {

constexpr double clear_of_motion = 2.0;  ///< bands of the rows
constexpr double below_nyquist = 0.8;    ///< of half the rate
constexpr std::size_t fewest_bins = 8;
constexpr Eigen::Index fewest_samples = 64;  ///< samples

/// Densities of one joint's torque above the motion.
void append_densities(const traced_log& log, Eigen::Index joint, std::vector<double>& densities) {
    const double band = 0.4 * log.rows.rate;
    const double rate = log.samples.rate;
    if (log.samples.samples() < fewest_samples) {
        return;
    }
    const power_spectrum spectrum =
        welch_spectrum(log.samples.tau.col(joint), rate, welch_segment(log.samples.samples()));
    for (Eigen::Index k = 0; k < spectrum.frequency.size(); ++k) {
        const double f = spectrum.frequency[k];
        if (f > clear_of_motion * band && f < below_nyquist * 0.5 * rate) {
            densities.push_back(spectrum.density[k]);
        }
    }
}

}  // namespace

noise_floor floor_from_spectrum(const std::vector<traced_log>& logs) {
    noise_floor floor;
    const Eigen::Index joints = logs.front().samples.tau.cols();
    floor.rms = Eigen::VectorXd::Zero(joints);
    for (Eigen::Index j = 0; j < joints; ++j) {
        std::vector<double> densities;
        for (const traced_log& log : logs) {
            append_densities(log, j, densities);
        }
        if (densities.size() < fewest_bins) {
            return {};
        }
        const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
        std::nth_element(densities.begin(), middle, densities.end());
        floor.rms[j] = std::sqrt(*middle * 0.4 * logs.front().rows.rate);
    }
    floor.from = "spectrum";
    return floor;
}

}  // namespace idim
