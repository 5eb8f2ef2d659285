#pragma once

#include <string>
#include <vector>

#include "traced_robot.hpp"

namespace idim::cli {

/// Writes `folder`/robot.yaml: the description with the effects of the trace added, comments kept; a bare URDF becomes
/// a description that names it. The URDF and the effect files that stand beside the description are copied with it.
/// Returns the path. Throws input_error where something cannot be read or written.
std::string write_refined_description(const std::string& robot_file, const traced_robot& traced,
                                      const std::vector<trace_step>& steps, const std::string& folder);

}  // namespace idim::cli
