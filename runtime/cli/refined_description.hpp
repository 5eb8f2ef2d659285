#pragma once

#include <string>
#include <vector>

#include "description/effect_insertion.hpp"
#include "traced_robot.hpp"

namespace idim::cli {

/// Writes `folder`/robot.yaml: the description with the effects of the trace added, comments kept; a bare URDF becomes
/// a description that names it. The URDF and the effect files that stand beside the description are copied with it.
/// Returns the path. Throws input_error where something cannot be read or written.
std::string write_refined_description(const std::string& robot_file, const traced_robot& traced,
                                      const std::vector<trace_step>& steps, const std::string& folder);

/// The same with items as they stand.
std::string write_with_effects(const std::string& robot_file, const std::vector<generator::effect_item>& items,
                               const std::string& folder);

}  // namespace idim::cli
