#include "idim/computed_torque.hpp"

namespace idim {

Eigen::VectorXd computed_torque::unlimited(const control_sample& sample) {
    const Eigen::VectorXd wanted =
        sample.qddr + kd.cwiseProduct(sample.qdr - sample.qd) + kp.cwiseProduct(sample.qr - sample.q);
    const Eigen::VectorXd temperature = Eigen::VectorXd::Constant(sample.q.size(), 20.0);
    Eigen::VectorXd tau(sample.q.size());
    model_->inverse_dynamics(sample.q.data(), sample.qd.data(), wanted.data(), sample.t, temperature.data(),
                             nominal_.data(), tau.data());
    return tau.cwiseQuotient(drive_gain);
}

}  // namespace idim
