#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "undeclared/sampler.hpp"

namespace idim::undeclared {

/// One row of modified Denavit-Hartenberg parameters of a serial chain (gamma = b = 0): Rot(x, alpha) Trans(x, d)
/// Rot(z, theta) Trans(z, r), the coordinate being added to theta, or to r of a prismatic joint.
struct chain_row {
    double alpha = 0.0, d = 0.0, theta = 0.0, r = 0.0;  ///< [rad], [m]
    bool prismatic = false;
};

/// A rigid body in the frame of its link.
struct solid {
    double mass = 0.0;                                          ///< [kg]
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();           ///< of mass [m]
    Eigen::Matrix3d central_inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass [kg m^2]

    solid operator+(const solid& other) const;  ///< both bodies as one
};

/// A body of some density: 3 extents of about `size` [m], which is also about how far its centre is off.
solid random_solid(double mass, double size, sampler& random);

/// What turns one joint beside its link. Units are N or N m, m or rad.
struct drive {
    double rotor_inertia = 0.0, viscous = 0.0, coulomb = 0.0, offset = 0.0;
    double position_limit = 0.0;  ///< the joint moves within plus and minus this
    double velocity_limit = 0.0;
};

/// A robot that could exist, with every number of it.
struct arm {
    std::string kind;  ///< scara, vertical, scara4, 3r, ppr, 6r, 7r, gantry
    Eigen::Vector3d gravity = {0.0, 0.0, -9.81};
    std::vector<chain_row> rows;
    std::vector<solid> links;
    std::vector<drive> drives;

    int dof() const { return static_cast<int>(rows.size()); }
};

/// Geometry, links and limits of a robot of this kind; rotors and friction are of no size yet (see sized_drives).
/// Throws std::invalid_argument for a kind that is not one of the above.
arm random_arm(const std::string& kind, sampler& random);

}  // namespace idim::undeclared
