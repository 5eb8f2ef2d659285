#include "description/urdf/common_normal.hpp"

#include <Eigen/Geometry>

namespace idim::generator {

common_normal normal_between(const spatial_line& first, const spatial_line& second) {
    const decimal_vector apart = second.point - first.point;
    const decimal_vector cross = first.direction.cross(second.direction);
    const decimal sine = cross.norm();
    common_normal normal;
    normal.parallel = sine < geometric_tolerance;
    if (normal.parallel) {
        const decimal_vector across = apart - first.direction * first.direction.dot(apart);
        const decimal distance = across.norm();
        normal.second = -second.direction.dot(apart);
        if (distance >= geometric_tolerance) {
            normal.direction = across / distance;
            normal.length = distance;
        }
        return normal;
    }
    normal.direction = cross / sine;
    normal.first = apart.cross(second.direction).dot(cross) / (sine * sine);
    normal.second = apart.cross(first.direction).dot(cross) / (sine * sine);
    normal.length = apart.dot(normal.direction);
    return normal;
}

}  // namespace idim::generator
