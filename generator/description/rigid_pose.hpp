#pragma once

#include <Eigen/Geometry>
#include <array>

#include "description/decimal.hpp"

namespace idim::generator {

/// Pose of a frame B in a frame A: R's columns are B's axes in A, p is B's origin in A [m].
struct rigid_pose {
    decimal_matrix R = decimal_matrix::Identity();
    decimal_vector p = decimal_vector::Zero();

    rigid_pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

/// Pose of C in A, from those of B in A and of C in B.
inline rigid_pose operator*(const rigid_pose& a_b, const rigid_pose& b_c) {
    return {a_b.R * b_c.R, a_b.p + a_b.R * b_c.p};
}

/// Rot(z, rpy[2]) Rot(y, rpy[1]) Rot(x, rpy[0]) behind a translation: the origin of a URDF element. Angles [rad] that
/// are a multiple of pi/2 to double precision turn by exactly that.
rigid_pose pose_of(const std::array<double, 3>& xyz, const std::array<double, 3>& rpy);

}  // namespace idim::generator
