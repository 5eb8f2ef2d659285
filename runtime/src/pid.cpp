#include "idim/pid.hpp"

namespace idim {

void pid::tune(const Eigen::VectorXd& inertia) {
    if (natural_frequency.size() > 0) {
        const Eigen::VectorXd scale = natural_frequency.cwiseProduct(inertia).cwiseQuotient(drive_gain);
        kp = natural_frequency.cwiseProduct(scale);
        kd = 2.0 * damping.cwiseProduct(scale);
    }
}

Eigen::VectorXd pid::unlimited(const control_sample& sample) {
    const Eigen::VectorXd error = sample.qr - sample.q;
    step_ = error / rate;
    sum_ = sum_.size() == 0 ? step_ : Eigen::VectorXd(sum_ + step_);
    return kp.cwiseProduct(error) + ki.cwiseProduct(sum_) + kd.cwiseProduct(sample.qdr - sample.qd);
}

void pid::limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) {
    sum_ -= (wanted.array() == given.array()).select(0.0, step_);
}

void pid::forget() {
    sum_.resize(0);
}

}  // namespace idim
