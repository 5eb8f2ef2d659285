#pragma once

#include <string>
#include <vector>

#include "description/robot_description.hpp"

namespace idim::generator {

/// A robot description as far as a URDF file gives one.
struct urdf_robot {
    std::string name;
    std::vector<joint_description> joints;
    std::vector<int> written_row;  ///< of each joint: its place among the joints of the file
    std::vector<int>
        actuated;  ///< joints with a coordinate of their own, without the parts of planar and floating joints
    std::map<std::string, double> inertial;   ///< a-priori parameters XX<label> .. M<label>
    std::map<int, double> damping, friction;  ///< of the joints that give it
    std::vector<link_placement> links;        ///< one for each joint
    std::vector<std::string> notes;
};

/// Reads a URDF file into modified Denavit-Hartenberg rows (frame_placement.hpp). One row for each axis, and one for
/// each link with inertia that is fixed to a moving one: a fixed row of zeros, so that its parameters are given in the
/// frame of the link it is fixed to and its transform costs nothing. Names that are no identifiers become the nearest
/// one. Throws input_error.
urdf_robot read_urdf_robot(const std::string& file);

}  // namespace idim::generator
