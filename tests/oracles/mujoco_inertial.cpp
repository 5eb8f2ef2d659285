#include "oracles/mujoco_inertial.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace idim::test {

std::string mujoco_inertial(const rigid_link& link) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(link.central_inertia);
    Eigen::Matrix3d axes = principal.eigenvectors();
    axes.col(2) *= axes.determinant() > 0.0 ? 1.0 : -1.0;
    const Eigen::Quaterniond turn(axes);
    const Eigen::Vector3d& I = principal.eigenvalues();
    return fmt::format("<inertial mass='{}' pos='{} {} {}' quat='{} {} {} {}' diaginertia='{} {} {}'/>", link.mass,
                       link.centre.x(), link.centre.y(), link.centre.z(), turn.w(), turn.x(), turn.y(), turn.z(), I[0],
                       I[1], I[2]);
}

}  // namespace idim::test
