#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "oracles/text_value.hpp"

namespace idim::test {

/// A rigid body in the frame of its link.
struct rigid_link {
    double mass = 0.0;                                          ///< [kg]
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();           ///< of mass [m]
    Eigen::Matrix3d central_inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass [kg m^2]
};

/// Links that could exist: positive masses, and central inertias that are those of a density (positive second moments
/// along some axes, so that the triangle inequalities hold). 0.5 to 8 kg, centres within 0.15 m, extents of 2 to 15 cm.
std::vector<rigid_link> plausible_links(int count, std::mt19937_64& random);

/// XX1 .. M1, XX2 ..: inertia about the origin of the link's frame and first moments [IV 3].
value_table standard_parameters_of(const std::vector<rigid_link>& links);

}  // namespace idim::test
