#include "idim/control_law.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace idim {

Eigen::VectorXd pd_cascade::torque(const Eigen::VectorXd& qr, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& qd) const {
    Eigen::VectorXd v = kv.cwiseProduct(kp.cwiseProduct(qr - q) - qd);
    if (saturation.size() > 0) {
        v = v.cwiseMax(-saturation).cwiseMin(saturation);
    }
    return drive_gain.cwiseProduct(v);
}

Eigen::VectorXd largest_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi) {
    constexpr int configurations = 2000;
    std::mt19937_64 random(1);
    const int n = model.dof;
    Eigen::VectorXd q(n);
    Eigen::MatrixXd M(n, n);
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(n);
    for (int s = 0; s < configurations; ++s) {
        for (int j = 0; j < n; ++j) {
            const double uniform = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
            q[j] = s == 0 ? 0.0 : (model.joint_is_prismatic[j] != 0 ? uniform : std::numbers::pi * uniform);
        }
        model.mass_matrix(q.data(), chi.data(), M.data());
        largest = largest.cwiseMax(M.diagonal());
    }
    return largest;
}

pd_cascade tune_pd_cascade(double rate, const Eigen::VectorXd& wn, const Eigen::VectorXd& zeta,
                           const Eigen::VectorXd& inertia, const Eigen::VectorXd& drive_gain) {
    pd_cascade law;
    law.rate = rate;
    law.kp = wn.cwiseQuotient(2.0 * zeta);
    law.kv = (2.0 * zeta.cwiseProduct(wn).cwiseProduct(inertia)).cwiseQuotient(drive_gain);
    law.drive_gain = drive_gain;
    return law;
}

}  // namespace idim
