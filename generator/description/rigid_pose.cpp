#include "description/rigid_pose.hpp"

namespace idim::generator {

rigid_pose pose_of(const std::array<double, 3>& xyz, const std::array<double, 3>& rpy) {
    const unit_vector r = angle_of(rpy[0]).direction();
    const unit_vector p = angle_of(rpy[1]).direction();
    const unit_vector y = angle_of(rpy[2]).direction();
    decimal_matrix roll, pitch, yaw;
    roll << 1, 0, 0, 0, r.cos, -r.sin, 0, r.sin, r.cos;
    pitch << p.cos, 0, p.sin, 0, 1, 0, -p.sin, 0, p.cos;
    yaw << y.cos, -y.sin, 0, y.sin, y.cos, 0, 0, 0, 1;
    return {yaw * pitch * roll, {decimal_of(xyz[0]), decimal_of(xyz[1]), decimal_of(xyz[2])}};
}

}  // namespace idim::generator
