#pragma once

#include <optional>

#include "description/joint_reader.hpp"
#include "description/robot_description.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

/// Reads the map `control` of a robot; nothing where there is none. Values are one for all joints that move, or a list
/// in the order of the file. Throws input_error for a list of another length and a law without a name.
std::optional<control_description> read_control(const yaml_fields& robot, const ordered_joints& ordered);

}  // namespace idim::generator
