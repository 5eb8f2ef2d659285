#pragma once

#include <string>
#include <vector>

#include "idim/motion_limits.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::cli {

/// Frames of the links as numbers. The tree has no closed loops.
std::vector<link_row> link_rows(const generator::kinematic_tree& tree);

/// Boxes of a YAML list of {link, point, box: [[low, high] of x, y, z]}; each is named "FILE:LINE: box of LINK". Throws
/// input_error naming file, line and field for anything else, and for a link that the robot does not have.
std::vector<workspace_box> read_workspace(const std::string& file, const generator::kinematic_tree& tree);

}  // namespace idim::cli
