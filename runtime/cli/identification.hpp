#pragma once

#include "measured_motion.hpp"

namespace idim::cli {

/// A robot's parameters identified from rows, and what it took.
struct identification {
    const loaded_robot& robot;
    filter_choice filter;
    observation rows;
    estimate result;
    essential_parameters essential;
};

/// Least squares of the rows, essential parameters included where there is a result.
identification identify(const loaded_robot& robot, const filter_choice& filter, observation rows,
                        least_squares_method method);

/// The same of logs, whose rows are repeated with the estimate where they depend on it (fit_rows).
identification identify(const loaded_robot& robot, const filter_choice& filter, const std::vector<idim::log>& logs,
                        least_squares_method method);

/// JSON of `identify` (FORMATS.md).
json to_json(const identification& found, const std::string& method);

/// 100 std / |value| [IV 19].
double relative_percent(double std, double value);

}  // namespace idim::cli
