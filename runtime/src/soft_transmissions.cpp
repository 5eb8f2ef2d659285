#include "soft_transmissions.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "idim/recorded_states.hpp"

namespace idim {

soft_transmissions::soft_transmissions(const idim_model_interface& model, const Eigen::VectorXd& chi)
    : model_(model), chi_(chi) {
    for (int j = 0; j < model.dof; ++j) {
        if (stiffness_of(model, j) > 0.0) {
            joints_.push_back(j);
        }
    }
}

/// What the equations of motion miss: torques of all joints [n], then torques of the links behind soft joints.
Eigen::VectorXd soft_transmissions::residual(const instant& at, const Eigen::VectorXd& acceleration) const {
    const Eigen::Index n = model_.dof;
    Eigen::VectorXd motor_acceleration = acceleration.head(n);
    motor_acceleration(joints_) = acceleration.tail(count());
    Eigen::VectorXd signals = at.signals;
    signals.segment(n + model_.n_states, 3 * n) << at.motor, at.motor_speed, motor_acceleration;

    Eigen::VectorXd result(n + count());
    model_.inverse_dynamics(at.link, at.link_speed.data(), acceleration.data(), at.t, signals.data(), chi_.data(),
                            result.data());
    result.head(n) -= at.tau;
    Eigen::VectorXd of_links(n);
    model_.rigid_torque(at.link, at.link_speed.data(), acceleration.data(), at.t, chi_.data(), of_links.data());
    for (Eigen::Index k = 0; k < count(); ++k) {
        const int j = joints_[static_cast<std::size_t>(k)];
        result[n + k] = of_links[j] - stiffness_of(model_, j) * (at.motor[j] - at.link[j]) -
                        damping_of(model_, j) * (at.motor_speed[j] - at.link_speed[j]);
    }
    return result;
}

Eigen::MatrixXd soft_transmissions::slope(const instant& at, const Eigen::VectorXd& at_rest) const {
    const Eigen::Index size = at_rest.size();
    Eigen::MatrixXd result(size, size);
    for (Eigen::Index c = 0; c < size; ++c) {
        result.col(c) = residual(at, Eigen::VectorXd::Unit(size, c)) - at_rest;
    }
    return result;
}

bool soft_transmissions::accelerations(const instant& at, double* acceleration) const {
    constexpr int most = 4;  // one would do but for friction by the load of the links
    Eigen::Map<Eigen::VectorXd> result(acceleration, model_.dof + count());
    result.setZero();
    Eigen::VectorXd missing = residual(at, result);
    const double scale = 1.0 + missing.norm();
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope(at, missing));
    for (int i = 0; i < most && missing.norm() > 1e-12 * scale; ++i) {
        result -= factors.solve(missing);
        if (!result.allFinite()) {
            return false;
        }
        missing = residual(at, result);
    }
    return true;
}

Eigen::VectorXd soft_transmissions::links_at_rest(const Eigen::VectorXd& motor, double t) const {
    constexpr int most = 50;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(model_.dof);
    Eigen::VectorXd link = motor;
    Eigen::VectorXd torque(model_.dof);
    for (int i = 0; i < most && count() > 0; ++i) {
        model_.rigid_torque(link.data(), none.data(), none.data(), t, chi_.data(), torque.data());
        for (const int j : joints_) {
            link[j] = motor[j] - torque[j] / stiffness_of(model_, j);
        }
    }
    return link;
}

double soft_transmissions::fastest_swing(const Eigen::VectorXd& q) const {
    if (count() == 0) {
        return 0.0;
    }
    const Eigen::Index n = model_.dof;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd signals = Eigen::VectorXd::Zero(model_.n_signals);
    const instant at = {q.data(), none, q, none, none, 0.0, signals};
    const Eigen::MatrixXd A = slope(at, residual(at, Eigen::VectorXd::Zero(n + count())));
    const Eigen::MatrixXd compliance = A.inverse();
    double square = 0.0;
    for (Eigen::Index k = 0; k < count(); ++k) {
        const int j = joints_[static_cast<std::size_t>(k)];
        // A torque K (motor - link) more between the two: on the link alone, for the motor's equation has the sum.
        square += stiffness_of(model_, j) * std::abs(compliance(j, n + k) - compliance(n + k, n + k));
    }
    return std::isfinite(square) ? std::sqrt(square) : std::numeric_limits<double>::infinity();
}

}  // namespace idim
