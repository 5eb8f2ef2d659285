#include "idim/pd_cascade.hpp"

namespace idim {

void pd_cascade::tune(const Eigen::VectorXd& inertia) {
    if (natural_frequency.size() > 0) {
        kv = 2.0 * damping.cwiseProduct(natural_frequency).cwiseProduct(inertia).cwiseQuotient(drive_gain);
    }
}

Eigen::VectorXd pd_cascade::unlimited(const control_sample& sample) {
    return kv.cwiseProduct(kp.cwiseProduct(sample.qr - sample.q) - sample.qd);
}

pd_cascade tune_pd_cascade(double rate, const Eigen::VectorXd& wn, const Eigen::VectorXd& zeta,
                           const Eigen::VectorXd& inertia, const Eigen::VectorXd& drive_gain) {
    pd_cascade law;
    law.rate = rate;
    law.kp = wn.cwiseQuotient(2.0 * zeta);
    law.drive_gain = drive_gain;
    law.natural_frequency = wn;
    law.damping = zeta;
    law.tune(inertia);
    return law;
}

}  // namespace idim
