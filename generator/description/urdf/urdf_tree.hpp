#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "description/inertial_parameters.hpp"
#include "description/robot_description.hpp"

namespace idim::generator {

struct urdf_link {
    std::string name;
    input_location where;
    std::optional<urdf_inertial> inertial;  ///< none if all of it is zero
};

/// A continuous joint is a revolute one without limits of position.
enum class urdf_joint_type { fixed, revolute, prismatic, planar, floating };

/// The joint moves by multiplier * (position of `joint`) + offset.
struct urdf_mimic {
    int joint = 0;  ///< one that mimics none itself
    double multiplier = 1.0;
    double offset = 0.0;
};

/// The joint's frame is that of its child link at position zero.
struct urdf_joint {
    std::string name;
    input_location where;
    urdf_joint_type type = urdf_joint_type::fixed;
    int parent = 0;                                ///< link
    int child = 0;                                 ///< link
    std::array<double, 3> xyz = {0.0, 0.0, 0.0};   ///< of the joint's frame in that of the parent link [m]
    std::array<double, 3> rpy = {0.0, 0.0, 0.0};   ///< roll, pitch, yaw [rad]
    std::array<double, 3> axis = {1.0, 0.0, 0.0};  ///< in the joint's frame, of any length but zero; normal if planar
    joint_limits limits;
    std::optional<double> damping;   ///< [N*m*s/rad or N*s/m]
    std::optional<double> friction;  ///< [N*m or N]
    std::optional<urdf_mimic> mimic;

    bool has_one_axis() const { return type == urdf_joint_type::revolute || type == urdf_joint_type::prismatic; }
};

/// What a URDF file says of links and joints: every joint has its two links, every link but the root its one joint.
struct urdf_tree {
    std::string file;
    std::string name;
    std::vector<urdf_link> links;    ///< in the order of the file
    std::vector<urdf_joint> joints;  ///< in the order of the file
    int root = 0;                    ///< link
    std::vector<std::string> notes;  ///< what was read otherwise than written
};

}  // namespace idim::generator
