#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/input_error.hpp"
#include "idim/stored_log.hpp"
#include "motion_spectra.hpp"
#include "uniform_time.hpp"

// How the filter is chosen.
// In the acceleration spectrum the motion falls with the frequency while the noise of the position, white or nearly so,
// rises with f^4: between them lies a valley, above which the data say nothing of the motion. The rows keep the band
// that holds 99.9 % of the acceleration and torque energy found below the valley; the position filter is set so far
// above that band that it takes 0.001 % at its edge, so the regressor is not distorted where the rows look. Set against
// published choices: EMPS order 4, 100 Hz, decimation 10 (here 161 Hz, 10); other robots in tests/runtime.

namespace idim {
namespace {

constexpr int default_order = 4;
// Of the top speed, the practice of the TX40's published identification (data/tx40/README.md: 1 % of the speed limit):
// above the noise of a filtered encoder, and a few rows per reversal only.
constexpr double default_minimum_speed = 0.01;
constexpr double energy_share = 0.999;
// Loss of |H|^2 at the band edge. 2026-11-22: 5e-4, 5e-5 and 1e-5 were tried on the simulated SCARA and the measured
// EMPS, TX40 and Panda; 1e-5 left the simulated inertia of joint 2 the least biased (0.09 % against 0.13 %).
constexpr double droop = 1e-5;
constexpr double least_rise = 4.0;  // of the acceleration spectrum above its valley, for a noise floor to count as seen
constexpr double largest_cutoff = 0.4;  // of the rate: 0.8 of the Nyquist frequency
constexpr double decade = 10.0;         // [CWLS III]: cut-off a decade above the highest frequency of the motion

/// Cut-off over band edge of a zero-phase Butterworth filter whose |H|^2 = 1 / (1 + (f / f_c)^(2 order)) loses `droop`
/// there.
double cutoff_over_band(int order) {
    return std::pow((1.0 - droop) / droop, 0.5 / order);
}

/// Mean density within a quarter octave on both sides of `f`.
double half_octave_mean(const power_spectrum& spectrum, double f) {
    const double resolution = spectrum.frequency[1];
    const double quarter_octave = std::exp2(0.25);
    const auto last = static_cast<Eigen::Index>(spectrum.frequency.size() - 1);
    const auto from = std::min(last, static_cast<Eigen::Index>(std::ceil(f / quarter_octave / resolution)));
    const auto to = std::clamp(static_cast<Eigen::Index>(f * quarter_octave / resolution), from, last);
    return spectrum.density.segment(from, to - from + 1).mean();
}

/// Where the acceleration sinks into its noise: the lowest point of the geometric mean of all acceleration spectra, on
/// a grid of sixth octaves. Infinite where the spectrum does not rise again. The geometric mean needs no common unit of
/// the joints.
double find_noise_floor(const std::vector<joint_spectra>& spectra, double rate) {
    std::vector<double> lowest;
    lowest.reserve(spectra.size());
    for (const joint_spectra& joint : spectra) {
        lowest.push_back(joint.lowest);
    }
    std::nth_element(lowest.begin(), lowest.begin() + lowest.size() / 2, lowest.end());
    double valley = std::numeric_limits<double>::infinity();
    double floor = std::numeric_limits<double>::infinity();
    double rise = 0.0;
    for (double f = lowest[lowest.size() / 2]; f * std::exp2(0.25) <= 0.5 * rate; f *= std::exp2(1.0 / 6.0)) {
        double level = 0.0;
        for (const joint_spectra& joint : spectra) {
            level += std::log(std::max(half_octave_mean(joint.acceleration, f), std::numeric_limits<double>::min()));
        }
        level /= static_cast<double>(spectra.size());
        if (level < floor) {
            floor = level;
            valley = f;
            rise = 0.0;
        }
        rise = std::max(rise, level - floor);
    }
    return rise >= std::log(least_rise) ? valley : std::numeric_limits<double>::infinity();
}

/// Frequency below which every joint's acceleration, and its torque if `with_torque`, has `energy_share` of its energy.
double energy_band(const std::vector<joint_spectra>& spectra, double limit, bool with_torque) {
    double band = 0.0;
    for (const joint_spectra& joint : spectra) {
        band = std::max(band, energy_frequency(joint.acceleration, energy_share, limit));
        if (with_torque && joint.torque.density.size() > 0) {
            band = std::max(band, energy_frequency(joint.torque, energy_share, limit));
        }
    }
    return band;
}

/// Two significant digits: more would pretend a precision that the valley does not have.
double rounded(double frequency) {
    const double scale = std::pow(10.0, 1.0 - std::floor(std::log10(frequency)));
    return std::round(frequency * scale) / scale;
}

void check_request(const filter_request& request, double rate) {
    if (request.cutoff && !(*request.cutoff >= 0.0 && *request.cutoff < 0.5 * rate)) {
        throw input_error({"", 0, "cutoff"},
                          fmt::format("{:.6g} Hz is neither 0 (no filter) nor between 0 and half the sampling rate, "
                                      "{:.6g} Hz",
                                      *request.cutoff, 0.5 * rate));
    }
    if (request.order && (*request.order < 1 || *request.order > 12)) {
        throw input_error({"", 0, "order"}, fmt::format("{} is not in 1..12", *request.order));
    }
    if (request.decimation && *request.decimation < 1) {
        throw input_error({"", 0, "decimation"}, fmt::format("{} is not a positive number", *request.decimation));
    }
    if (request.minimum_speed && !(*request.minimum_speed >= 0.0 && *request.minimum_speed < 1.0)) {
        throw input_error(
            {"", 0, "minimum_speed"},
            fmt::format("{:.6g} is not a part of the top speed from 0 to below 1", *request.minimum_speed));
    }
}

std::string speed_reason(double minimum_speed) {
    return minimum_speed > 0.0
               ? fmt::format("rests (below {:.3g} % of a joint's top speed) left out", 100.0 * minimum_speed)
               : "rows kept at any speed";
}

/// A cut-off, the band it leaves undistorted, and why.
struct cutoff_choice {
    double cutoff = 0.0;
    double band = 0.0;
    std::string reason;
};

cutoff_choice choose_cutoff(const std::vector<joint_spectra>& spectra, double rate, int order) {
    const double valley = find_noise_floor(spectra, rate);
    const double ratio = cutoff_over_band(order);
    const double limit = largest_cutoff * rate;
    cutoff_choice choice;
    if (std::isfinite(valley)) {
        choice.band = std::min(energy_band(spectra, valley, true), limit / ratio);
        choice.cutoff = rounded(choice.band * ratio);
        choice.reason = fmt::format(
            "cut-off {:.4g} Hz chosen: the acceleration sinks into its noise at {:.3g} Hz, 99.9 % of the "
            "acceleration and torque below that lie below {:.3g} Hz, and the filter takes 0.001 % there",
            choice.cutoff, valley, choice.band);
        return choice;
    }
    const double motion = energy_band(spectra, 0.5 * rate, false);
    choice.cutoff = rounded(std::min(decade * motion, limit));
    choice.band = choice.cutoff / ratio;
    choice.reason = fmt::format(
        "cut-off {:.4g} Hz chosen: no noise floor is seen in the position, so a decade above {:.3g} Hz, "
        "below which 99.9 % of the acceleration lie, but not above {:.4g} Hz",
        choice.cutoff, motion, limit);
    return choice;
}

/// No position filter, and no decimation unless it is asked for.
filter_choice unfiltered(const filter_request& request, double rate) {
    filter_choice choice;
    choice.decimation = request.decimation.value_or(1);
    choice.minimum_speed = request.minimum_speed.value_or(default_minimum_speed);
    choice.reason = fmt::format("position not filtered, as asked for; decimation {}: the rows keep 0 to {:.3g} Hz; {}",
                                choice.decimation, choice.decimation > 1 ? choice.band(rate) : 0.5 * rate,
                                speed_reason(choice.minimum_speed));
    return choice;
}

filter_choice choose_filter(const std::vector<readable_log>& logs, const filter_request& request) {
    if (logs.empty()) {
        throw input_error({"", 0, ""}, "no log was given");
    }
    std::vector<named_rate> rates;
    std::vector<joint_spectra> spectra;
    for (const readable_log& data : logs) {
        rates.push_back({data.file, data.rate});
        if (!request.cutoff) {
            append_spectra(data, spectra);
        }
    }
    require_common_rate(rates);
    const double rate = rates.front().rate;
    check_request(request, rate);
    if (!request.cutoff && spectra.empty()) {
        throw input_error({logs.front().file, 0, "q1"}, "no joint moves, nothing can be identified from this log");
    }

    if (request.cutoff && *request.cutoff == 0.0) {
        return unfiltered(request, rate);
    }
    filter_choice choice;
    choice.order = request.order.value_or(default_order);
    cutoff_choice cutoff;
    if (request.cutoff) {
        cutoff = {*request.cutoff, *request.cutoff / cutoff_over_band(choice.order),
                  fmt::format("cut-off {:.4g} Hz given", *request.cutoff)};
    } else {
        cutoff = choose_cutoff(spectra, rate, choice.order);
    }
    choice.cutoff = cutoff.cutoff;
    const double finest = std::max(1.0, std::floor(filter_choice{}.band(rate) / cutoff.band));
    choice.decimation = request.decimation.value_or(static_cast<int>(finest));
    choice.minimum_speed = request.minimum_speed.value_or(default_minimum_speed);
    choice.reason = fmt::format("Butterworth order {} {}; {}; decimation {} {}: the rows keep 0 to {:.3g} Hz; {}",
                                choice.order, request.order ? "given" : "by default", cutoff.reason, choice.decimation,
                                request.decimation ? "given" : "chosen to keep the band the filter leaves alone",
                                choice.band(rate), speed_reason(choice.minimum_speed));
    return choice;
}

}  // namespace

double filter_choice::band(double rate) const {
    return 0.8 * rate / (2.0 * decimation);
}

filter_choice choose_filter(const std::vector<log>& logs, const filter_request& request) {
    std::vector<readable_log> readable;
    for (const log& data : logs) {
        readable.push_back(readable_in_memory(data));
    }
    return choose_filter(readable, request);
}

filter_choice choose_filter(const std::vector<stored_log>& logs, const filter_request& request) {
    std::vector<readable_log> readable;
    for (const stored_log& data : logs) {
        readable.push_back({data.file(), data.samples(), data.rate(),
                            [&data](Eigen::Index first, Eigen::Index count) { return data.part(first, count); }});
    }
    return choose_filter(readable, request);
}

}  // namespace idim
