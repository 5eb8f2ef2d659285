#include "idim/p_position.hpp"

namespace idim {

void p_position::tune(const Eigen::VectorXd& inertia) {
    if (natural_frequency.size() > 0) {
        kv = 2.0 * damping.cwiseProduct(natural_frequency).cwiseProduct(inertia).cwiseQuotient(drive_gain);
    }
}

Eigen::VectorXd p_position::unlimited(const control_sample& sample) {
    const Eigen::VectorXd wanted = kp.cwiseProduct(sample.qr - sample.q) + kf.cwiseProduct(sample.qdr);
    const Eigen::VectorXd error = wanted - sample.qd;
    step_ = error / rate;
    sum_ = sum_.size() == 0 ? step_ : Eigen::VectorXd(sum_ + step_);
    return kv.cwiseProduct(error) + ki.cwiseProduct(sum_);
}

void p_position::limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) {
    sum_ -= (wanted.array() == given.array()).select(0.0, step_);
}

void p_position::forget() {
    sum_.resize(0);
}

}  // namespace idim
