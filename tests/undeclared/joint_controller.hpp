#pragma once

#include <Eigen/Core>

#include "undeclared/motion.hpp"
#include "undeclared/rigid_body_engine.hpp"

namespace idim::undeclared {

/// What a controller is tuned to.
struct controller_settings {
    double rate = 1000.0;     ///< [Hz]
    double bandwidth = 20.0;  ///< [rad/s]
    double damping = 0.9;
    double integral = 0.0;     ///< [1/s], times the proportional gain
    double gravity = 1.0;      ///< share of gravity that is compensated
    bool feedforward = false;  ///< torques of the reference by the rigid model and rotors
};

/// PD or PID control of each joint with compensation of gravity, as a sampled controller does it: from positions
/// alone, with a filtered difference for the velocity.
class joint_controller {
  public:
    /// inertia: what each drive moves about, links and rotor [kg m^2 or kg].
    joint_controller(const arm& robot, const controller_settings& settings, const Eigen::VectorXd& inertia);

    Eigen::VectorXd torque(const reference_point& reference, const Eigen::VectorXd& measured_q);

  private:
    controller_settings settings_;
    rigid_body_engine engine_;
    Eigen::VectorXd kp_, kv_, rotors_, last_q_, velocity_, sum_;
};

}  // namespace idim::undeclared
