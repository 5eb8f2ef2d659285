#pragma once

#include <vector>

#include "description/robot_description.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

/// Reads the list `effects` of a robot, each a name or a map {effect, joints, from, shape}; nothing where there is
/// none. Throws input_error for unknown or fixed joints, and an effect that is on a joint already.
std::vector<effect_use> read_effects(const yaml_fields& robot, const std::vector<joint_description>& joints);

}  // namespace idim::generator
