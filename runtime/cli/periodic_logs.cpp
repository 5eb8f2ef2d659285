#include "periodic_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "idim/input_error.hpp"
#include "option_text.hpp"

namespace idim::cli {

namespace {

std::optional<double> seconds_of(const std::string& text) {
    if (text == "auto") {
        return std::nullopt;
    }
    const std::optional<double> value = finite_number(text);
    if (!value || !(*value > 0.0)) {
        refuse_option("--period", text, "auto or a positive number of seconds");
    }
    return value;
}

/// One phrase: how the rows are weighted.
std::string covariance_phrase(const periodic_logs& periods, std::size_t log) {
    const torque_scatter& scatter = periods.scatter[log];
    if (!periods.weights()) {
        return "weights per joint, since the torque does not scatter from period to period";
    }
    const std::string from = fmt::format("{} periods, {} joints", scatter.deviations.size(), scatter.rms.size());
    if (scatter.pooled_share >= 1.0) {
        return fmt::format("torque covariance pooled over the period ({}): it does not visibly vary along it", from);
    }
    return fmt::format("torque covariance of every sample, shrunk by {:.0f} % towards that of the whole period ({})",
                       100.0 * scatter.pooled_share, from);
}

const char* covariance_name(const periodic_logs& periods, std::size_t log) {
    return !periods.weights() ? "none" : periods.scatter[log].pooled_share >= 1.0 ? "pooled" : "shrunk";
}

}  // namespace

bool periodic_logs::weights() const {
    return averages() &&
           std::all_of(scatter.begin(), scatter.end(), [](const torque_scatter& one) { return one.scatters; });
}

namespace {

/// Takes in a log that began at `start` [s]; false where it has no periods, and none were given.
bool add(const motion_source& motion, double start, std::optional<double> given, const filter_choice& filter,
         periodic_logs& periods) {
    const period_search found = find_period(motion, given);
    if (!found.part && given) {
        throw input_error({motion.file(), 0, "--period"}, found.obstacle);
    }
    if (!found.part) {
        periods.obstacle = fmt::format("{}: {}", motion.file(), found.obstacle);
        return false;
    }
    periods.files.push_back(motion.file());
    periods.parts.push_back(*found.part);
    periods.average.push_back(average_periods(motion, *found.part, filter));
    periods.scatter.push_back(scatter_of(motion, *found.part, filter));
    periods.rates.push_back(motion.rate());
    periods.starts.push_back(motion.part(found.part->first, 1).t[0] - start);
    return true;
}

}  // namespace

periodic_logs find_periods(const std::vector<idim::log>& logs, const filter_choice& filter, const std::string& period) {
    const std::optional<double> given = seconds_of(period);
    periodic_logs periods;
    for (const idim::log& log : logs) {
        const filtered_samples samples = filter_log(log, filter);
        if (!add(resident_motion(samples), log.t[0], given, filter, periods)) {
            break;
        }
    }
    return periods;
}

periodic_logs find_periods(const std::vector<stored_log>& logs, const filter_choice& filter,
                           const std::string& period) {
    const std::optional<double> given = seconds_of(period);
    periodic_logs periods;
    for (const stored_log& log : logs) {
        if (!add(*filter_log(log, filter), log.start(), given, filter, periods)) {
            break;
        }
    }
    return periods;
}

json to_json(const periodic_logs& periods, const loaded_robot& robot) {
    if (!periods.averages()) {
        return {{"averaged", false}, {"reason", periods.obstacle}};
    }
    json logs = json::array();
    for (std::size_t i = 0; i < periods.parts.size(); ++i) {
        const periodic_part& part = periods.parts[i];
        json joints = json::array();
        for (std::size_t j = 0; j < robot.generated.joints.size(); ++j) {
            joints.push_back({{"joint", robot.generated.joints[j].name},
                              {"scatter", periods.scatter[i].rms[static_cast<Eigen::Index>(j)]}});
        }
        logs.push_back({{"log", periods.files[i]},
                        {"period", static_cast<double>(part.period) / periods.rates[i]},
                        {"period_samples", part.period},
                        {"periods", part.periods},
                        {"transient_dropped", periods.starts[i]},
                        {"mismatch", part.mismatch},
                        {"covariance", covariance_name(periods, i)},
                        {"pooled_share", periods.weights() ? json(periods.scatter[i].pooled_share) : json(nullptr)},
                        {"joints", joints}});
    }
    return {{"averaged", true}, {"logs", logs}};
}

void print(const periodic_logs& periods) {
    if (!periods.averages()) {
        fmt::print("  not averaged, weights per joint: {}\n", periods.obstacle);
        return;
    }
    for (std::size_t i = 0; i < periods.parts.size(); ++i) {
        const periodic_part& part = periods.parts[i];
        fmt::print(
            "  {}: average of {} periods of {:.6g} s ({} samples) after {:.3g} s; they differ by {:.2g} % of the "
            "motion\n    {}\n",
            periods.files[i], part.periods, static_cast<double>(part.period) / periods.rates[i], part.period,
            periods.starts[i], 100.0 * part.mismatch, covariance_phrase(periods, i));
    }
}

}  // namespace idim::cli
