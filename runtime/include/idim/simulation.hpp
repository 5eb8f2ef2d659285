#pragma once

#include <cstdint>

#include "idim/control_law.hpp"
#include "idim/log.hpp"

namespace idim {

/// Measurement noise, white, Gaussian.
struct measurement_noise {
    Eigen::VectorXd position;  ///< [n] standard deviation [rad or m]; seen by the controller too
    Eigen::VectorXd torque;    ///< [n] standard deviation [N*m or N]
    std::uint64_t seed = 1;
};

/// A simulated motion: what a logger would have recorded, and what was true.
struct simulated_motion {
    log measured;  ///< t, q, tau, qr at the controller's rate
    log truth;     ///< t, q, qd, qdd, tau without noise
};

/// Closed loop of the direct dynamic model and a sampled control law that follows `reference` (its qr, interpolated
/// linearly): the drive holds its torque for one period, the robot moves on by Runge-Kutta of order four with
/// `substeps` steps in each. Starts at the reference, at rest. Friction is the model's sign(qd), so a joint that should
/// stick chatters about zero speed with an amplitude of one substep. The logged torque is the mean of the torques held
/// before and after the sample, as a filtered current measurement gives: the command alone would lead the motion by
/// half a period. Throws data_error where the inertia matrix of chi is not positive definite on the way, or the motion
/// diverges, naming time and joint.
simulated_motion simulate(const idim_model_interface& model, const Eigen::VectorXd& chi, const pd_cascade& law,
                          const log& reference, const measurement_noise& noise, int substeps = 10);

}  // namespace idim
