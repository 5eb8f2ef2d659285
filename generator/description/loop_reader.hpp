#pragma once

#include <string>
#include <vector>

#include "description/robot_description.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

/// Reads the list `loops` of a robot and marks the joints that they determine as passive. Throws input_error for an
/// unknown or fixed joint, one that two loops determine or that has another variable than `q`, and a cut within a link.
std::vector<loop_description> read_loops(const yaml_value& written, std::vector<joint_description>& joints);

/// "1", "-1" or "parallelogram".
std::string to_string(loop_assembly assembly);

/// One loop as it may be written: {cut: [...], passive: [...], assembly: 1}.
std::string to_string(const loop_description& loop, const std::vector<joint_description>& joints);

}  // namespace idim::generator
