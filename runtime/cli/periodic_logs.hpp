#pragma once

#include <string>
#include <vector>

#include "idim/periodic.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// The periods of the logs of one identification, or why there are none.
struct periodic_logs {
    std::vector<filtered_samples> average;  ///< of each log
    std::vector<periodic_part> parts;
    std::vector<torque_scatter> scatter;
    std::vector<double> rates;   ///< [Hz]
    std::vector<double> starts;  ///< time of the first sample averaged less that of the log [s]
    std::string obstacle;        ///< with --period auto: what made the rows those of the whole logs
    std::vector<std::string> files;

    bool averages() const { return obstacle.empty(); }
    /// Whether rows are weighted by the scatter of the torque: it scatters in every log.
    bool weights() const;
};

/// `period`: auto, or seconds. Throws input_error for a number that cannot be read, and for given periods that the logs
/// do not hold; where `auto` finds none, obstacle says why.
periodic_logs find_periods(const std::vector<idim::log>& logs, const filter_choice& filter, const std::string& period);
periodic_logs find_periods(const std::vector<stored_log>& logs, const filter_choice& filter, const std::string& period);

/// `periodic` of the JSON of identify.
json to_json(const periodic_logs& periods, const loaded_robot& robot);
void print(const periodic_logs& periods);

}  // namespace idim::cli
