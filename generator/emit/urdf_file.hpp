#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/robot_description.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// A URDF and what of the robot it cannot hold.
struct urdf_file {
    std::string text;
    std::vector<std::string> notes;
};

/// The URDF that `robot` was read from (`text`), with the inertias, and of moving joints damping Fv and friction Fc,
/// that `parameters` give by the names of standard parameters; what they do not name stays. Comments are not kept.
/// Throws input_error.
urdf_file with_parameters(const std::string& text, const std::string& file, const robot_description& robot,
                          const std::map<std::string, double>& parameters);

/// A URDF of a tree of modified Denavit-Hartenberg frames: links hang in these frames, joints move about or along their
/// z. Throws input_error for joints that move with several coordinates, or by something else than their own coordinate,
/// and for first moments without mass.
urdf_file to_urdf(const robot_description& robot, const kinematic_tree& tree,
                  const std::map<std::string, double>& parameters);

}  // namespace idim::generator
