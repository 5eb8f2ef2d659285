#include "idim/emps_law.hpp"

namespace idim {

Eigen::VectorXd emps_law::unlimited(const control_sample& sample) {
    if (last_.size() == 0) {
        last_ = before_last_ = sample.q;
    }
    const Eigen::VectorXd velocity = 0.5 * rate * (sample.q - before_last_);
    before_last_ = last_;
    last_ = sample.q;
    return kv.cwiseProduct(kp.cwiseProduct(sample.qr - sample.q) - velocity);
}

void emps_law::forget() {
    last_.resize(0);
}

}  // namespace idim
