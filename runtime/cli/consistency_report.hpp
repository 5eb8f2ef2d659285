#pragma once

#include "idim/consistent_fit.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// "consistency" of the JSON of identify --method cwls.
json to_json(const consistent_estimate& found, const loaded_robot& robot);

/// Proof of the optimum, links, active constraints, cost against weighted least squares, inertia matrix over
/// configurations.
void print_consistency(const consistent_estimate& found);

}  // namespace idim::cli
