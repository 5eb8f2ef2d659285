#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace idim {

/// XX XY XZ YY YZ ZZ [kg m^2], MX MY MZ [kg m], M [kg] of a body about the origin of its frame, in its axes [IV 3].
using body_parameters = Eigen::Matrix<double, 10, 1>;

/// A rigid body (a link or a payload) among the standard parameters of a robot.
struct inertial_body {
    std::string name;                     ///< "link of j3"
    std::array<Eigen::Index, 10> places;  ///< of body_parameters among the standard parameters

    body_parameters of(const Eigen::VectorXd& standard) const { return standard(places); }
};

/// [Sigma h; h' m], Sigma = tr(I)/2 E - I the second moments of mass about the origin, h the first moments [Wensing,
/// Kim and Slotine 2017, IEEE Robotics and Automation Letters 3]. Positive definite if and only if some density of
/// positive mass has these parameters, so that m > 0, I_g > 0 and the triangle inequalities hold.
Eigen::Matrix4d pseudo_inertia(const body_parameters& body);

/// The inverse of pseudo_inertia.
body_parameters parameters_of_pseudo_inertia(const Eigen::Matrix4d& P);

/// [I S(h); S(h)' m E], S(h) v = h x v: positive definite if and only if m > 0 and I_g > 0 [Sousa and Cortesao 2014,
/// Int. Journal of Robotics Research 33].
Eigen::Matrix<double, 6, 6> spatial_inertia(const body_parameters& body);

/// I_g [kg m^2], inertia about the centre of mass in the axes of the frame [CWLS 14]; the mass must not be zero.
Eigen::Matrix3d central_inertia(const body_parameters& body);

}  // namespace idim
