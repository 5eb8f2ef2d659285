#pragma once

#include "traced_robot.hpp"

namespace idim::cli {

/// E of FORMATS.md on logs fitted and held back.
json to_json(const trace_errors& errors, const loaded_robot& robot);

/// JSON of `diagnose` and `refine` (FORMATS.md) but for the errors before and after, and what only refine has.
json to_json(const effect_trace& trace, const traced_robot& robot);

/// "effects_added", "unexplained_residual" or "no_missing_effect".
std::string verdict_of(const effect_trace& trace);

/// What an effect is at, for people: "joint_coupling at j5, j6", "coupling_friction at j6 from j5".
std::string describe(const effect_place& place, const loaded_robot& robot);

/// A coefficient with its deviation, "K = 0.04 (std 0.0012) N*m/rad", or that this motion does not show it apart.
std::string describe(const effect_parameter& parameter);

/// The term, its p-value and what the errors become without it and those listed before it, from errors `with` all.
std::string describe(const unsupported_term& term, const trace_errors& with, const loaded_robot& robot);

}  // namespace idim::cli
