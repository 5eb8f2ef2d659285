#pragma once

#include <Eigen/Core>

#include "undeclared/arm.hpp"
#include "undeclared/motion.hpp"

namespace idim::undeclared {

/// What is usual at each joint along a motion of the rigid links: the measure for drives, noise and effects.
struct joint_scales {
    Eigen::VectorXd torque;     ///< root mean square, drives included where they have a size [N m or N]
    Eigen::VectorXd speed;      ///< root mean square [rad/s or m/s]
    Eigen::VectorXd top_speed;  ///< largest
    Eigen::VectorXd range;      ///< largest distance from 0 [rad or m]
    Eigen::VectorXd inertia;    ///< mean diagonal of the inertia matrix, links alone [kg m^2 or kg]
};

joint_scales scales_along(const arm& robot, const motion& reference);

/// Rotor inertias of 0.3 to 1.2 of the links', Coulomb friction of 10 to 50 % and viscous friction of 5 to 40 % of the
/// usual torque; an offset on some joints.
void size_drives(arm& robot, const joint_scales& scales, bool offsets, sampler& random);

}  // namespace idim::undeclared
