#include "description/urdf/mdh_row.hpp"

#include <Eigen/Geometry>

namespace idim::generator {

namespace {

/// From a to b about the axis, both at right angles to it.
decimal angle_about(const decimal_vector& axis, const decimal_vector& a, const decimal_vector& b) {
    return atan2(axis.dot(a.cross(b)), a.dot(b));
}

}  // namespace

decimal_vector normal_direction(const axis_frame& antecedent, const spatial_line& axis) {
    const common_normal normal = normal_between(antecedent.axis(), axis);
    if (normal.direction.isZero()) {
        return antecedent.x;
    }
    const bool is_opposite = normal.direction.dot(antecedent.x) < -geometric_tolerance;
    return is_opposite ? decimal_vector(-normal.direction) : normal.direction;
}

mdh_row row_between(const axis_frame& antecedent, const axis_frame& frame) {
    const common_normal normal = normal_between(antecedent.axis(), frame.axis());
    const decimal_vector x = normal_direction(antecedent, frame.axis());
    mdh_row row;
    row.gamma = angle_about(antecedent.z, antecedent.x, x);
    row.b = normal.first;
    row.alpha = angle_about(x, antecedent.z, frame.z);
    row.d = normal.length * normal.direction.dot(x);
    row.theta = angle_about(frame.z, x, frame.x);
    row.r = -normal.second;
    return row;
}

}  // namespace idim::generator
