#include "idim/inertial_body.hpp"

namespace idim {

namespace {

Eigen::Matrix3d inertia_of(const body_parameters& b) {
    Eigen::Matrix3d I;
    I << b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5];
    return I;
}

}  // namespace

Eigen::Matrix4d pseudo_inertia(const body_parameters& body) {
    const Eigen::Matrix3d I = inertia_of(body);
    Eigen::Matrix4d P;
    P.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
    P.topRightCorner<3, 1>() = body.segment<3>(6);
    P.bottomLeftCorner<1, 3>() = body.segment<3>(6).transpose();
    P(3, 3) = body[9];
    return P;
}

body_parameters parameters_of_pseudo_inertia(const Eigen::Matrix4d& P) {
    const Eigen::Matrix3d S = P.topLeftCorner<3, 3>();
    const Eigen::Matrix3d I = S.trace() * Eigen::Matrix3d::Identity() - S;
    body_parameters body;
    body << I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2), P(0, 3), P(1, 3), P(2, 3), P(3, 3);
    return body;
}

Eigen::Matrix<double, 6, 6> spatial_inertia(const body_parameters& body) {
    Eigen::Matrix3d S;
    S << 0.0, -body[8], body[7], body[8], 0.0, -body[6], -body[7], body[6], 0.0;
    Eigen::Matrix<double, 6, 6> F;
    F << inertia_of(body), S, S.transpose(), body[9] * Eigen::Matrix3d::Identity();
    return F;
}

Eigen::Matrix3d central_inertia(const body_parameters& body) {
    const Eigen::Vector3d h = body.segment<3>(6);
    return inertia_of(body) - (h.squaredNorm() * Eigen::Matrix3d::Identity() - h * h.transpose()) / body[9];
}

}  // namespace idim
