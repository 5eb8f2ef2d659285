#pragma once

#include <vector>

#include "description/robot_description.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

/// The joints in order from the base, and the place each had in the file.
struct ordered_joints {
    std::vector<joint_description> joints;
    std::vector<int> written_row;
};

/// Reads the list `joints` of a robot, modified Denavit-Hartenberg rows in any order. Throws input_error for an unknown
/// antecedent, antecedents that form a cycle, a name that comes twice, and where no joint moves.
ordered_joints read_joints(const yaml_value& written);

}  // namespace idim::generator
