#include "undeclared/joint_controller.hpp"

#include <cmath>

namespace idim::undeclared {

joint_controller::joint_controller(const arm& robot, const controller_settings& settings,
                                   const Eigen::VectorXd& inertia)
    : settings_(settings),
      engine_(robot),
      kp_(inertia * settings.bandwidth * settings.bandwidth),
      kv_(inertia * 2.0 * settings.damping * settings.bandwidth),
      rotors_(robot.dof()),
      velocity_(Eigen::VectorXd::Zero(robot.dof())),
      sum_(Eigen::VectorXd::Zero(robot.dof())) {
    for (int j = 0; j < robot.dof(); ++j) {
        rotors_[j] = robot.drives[static_cast<std::size_t>(j)].rotor_inertia;
    }
}

Eigen::VectorXd joint_controller::torque(const reference_point& reference, const Eigen::VectorXd& measured_q) {
    constexpr double filter_time = 0.003;  // [s]
    const double period = 1.0 / settings_.rate;
    if (last_q_.size() == 0) {
        last_q_ = measured_q;
    }
    const double share = 1.0 - std::exp(-period / filter_time);
    velocity_ += share * ((measured_q - last_q_) / period - velocity_);
    last_q_ = measured_q;
    const Eigen::VectorXd error = reference.q - measured_q;
    sum_ += period * settings_.integral * error;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(error.size());
    Eigen::VectorXd model;
    if (settings_.feedforward) {
        engine_.inverse_dynamics(reference.q, reference.qd, reference.qdd, model);
        model += rotors_.cwiseProduct(reference.qdd);
    } else {
        engine_.inverse_dynamics(measured_q, zero, zero, model);
    }
    return kp_.cwiseProduct(error + sum_) + kv_.cwiseProduct(reference.qd - velocity_) + settings_.gravity * model;
}

}  // namespace idim::undeclared
