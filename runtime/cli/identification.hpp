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

/// Least squares of filtered logs, essential parameters included where there is a result. Rows that depend on the
/// estimate are repeated with it (fit_rows).
identification identify(const loaded_robot& robot, const filter_choice& filter,
                        const std::vector<filtered_samples>& logs, least_squares_method method);

/// Whether essential parameters were looked for: only least squares does.
bool has_essential(const identification& found);

/// JSON of `identify` (FORMATS.md).
json to_json(const identification& found, const std::string& method);

/// 100 std / |value| [IV 19].
double relative_percent(double std, double value);

}  // namespace idim::cli
