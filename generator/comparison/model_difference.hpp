#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison/model_summary.hpp"

namespace idim::generator {

/// How much of standard parameter `standard` a base parameter holds.
struct coefficient_change {
    std::string standard;
    double before = 0.0, after = 0.0;
};

/// A base parameter that keeps the same standard parameter, but not the same others with it.
struct regrouping_change {
    parameter_context before, after;
    std::vector<coefficient_change> coefficients;
};

/// An entry of the description, as text; empty where it does not exist.
struct entry_change {
    std::string what;   ///< constant; joint; effect and where it acts: "viscous_friction at j1"
    std::string field;  ///< "alpha", "shape vs"; empty for the whole
    std::string before, after;
};

/// Consecutive columns of the regressor (entries of chi) that moved together.
struct column_move {
    std::string first, last;  ///< names in the new model
    int before = 0, after = 0;
    int columns = 1;
};

struct operations_change {
    std::string function;
    operation_count before, after;
    bool in_both = true;
};

/// What changed from one model to another. Parameters are told apart by the names of the standard parameters kept in
/// them, joints, constants and effects by their own names.
struct model_difference {
    std::vector<parameter_context> base_added, base_dropped;
    std::vector<regrouping_change> regrouped;
    std::vector<std::string> standard_added, standard_dropped;
    std::vector<manifest_effect> effects_added, effects_removed;  ///< each with the joints where it is new or gone
    std::vector<entry_change> effects_changed, constants, gravity, joints, loops;
    std::vector<column_move> columns;
    std::vector<operations_change> operations;  ///< every function, changed or not
    std::optional<std::string> not_comparable;  ///< why the two torques cannot be compared

    /// Nothing above differs.
    bool empty() const;
};

model_difference compare(const model_summary& before, const model_summary& after);

}  // namespace idim::generator
