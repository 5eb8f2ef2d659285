#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/rigid_pose.hpp"
#include "description/urdf/urdf_tree.hpp"

namespace idim::generator {

inline std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// A link that moves with an axis.
struct carried_link {
    int link = 0;     ///< in urdf_tree::links
    int joint = 0;    ///< in urdf_tree::joints: the one it hangs on
    rigid_pose pose;  ///< of the link's frame in the base frame while every joint is at zero
};

/// The joint variable of a mimic joint: multiplier * (that of `axis`) + offset.
struct followed_axis {
    int axis = 0;
    double multiplier = 1.0;
    double offset = 0.0;
};

/// One degree of freedom of a robot that stands at zero: a line in space about or along which everything outward of it
/// moves. The base frame is that of the root link.
struct moving_axis {
    std::string name;
    joint_type type = joint_type::revolute;  ///< revolute or prismatic
    int joint = 0;                           ///< in urdf_tree::joints
    int antecedent = base_link;              ///< the axis it moves with, always before it
    decimal_vector point, direction;         ///< of the line, in the base frame [m, unit length]
    std::optional<followed_axis> follows;
    bool is_part = false;  ///< of a planar or floating joint
    std::vector<carried_link>
        links;  ///< the joint's child link, then those fixed to it; a part that is not the last has none
};

/// The moving axes of a URDF, in the order of the file, moved back only where an antecedent comes later. A planar joint
/// is prismatic joints <joint>_x and <joint>_y and a revolute joint <joint>_yaw about the normal; x and y are those of
/// the joint's frame after the smallest rotation that takes its z to the normal. A floating joint is prismatic joints
/// <joint>_x _y _z along the axes of the joint's frame, then <joint>_yaw _pitch _roll about z, y, x as they have moved:
/// singular at a pitch of +-pi/2, where yaw and roll turn about one line. What is fixed to the root has no axis and is
/// left out.
std::vector<moving_axis> moving_axes(const urdf_tree& tree);

}  // namespace idim::generator
