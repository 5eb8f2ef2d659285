#include <Eigen/Eigenvalues>
#include <numbers>
#include <random>

#include "idim/consistent_fit.hpp"

namespace idim {

inertia_scan scan_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi, int configurations) {
    std::mt19937_64 random(1);
    const int n = model.dof;
    Eigen::VectorXd q(n);
    Eigen::MatrixXd M(n, n);
    inertia_scan scan;
    scan.configurations = configurations;
    scan.smallest = std::numeric_limits<double>::infinity();
    int not_positive = 0;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(n);
    for (int s = 0; s < configurations; ++s) {
        for (int j = 0; j < n; ++j) {
            const double uniform = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
            q[j] = s == 0 ? 0.0 : (model.joint_is_prismatic[j] != 0 ? uniform : std::numbers::pi * uniform);
        }
        model.mass_matrix(q.data(), chi.data(), M.data());
        // Rows that a gain error scales make M unsymmetric.
        eigen.compute(0.5 * (M + M.transpose()), Eigen::EigenvaluesOnly);
        scan.smallest = std::min(scan.smallest, eigen.eigenvalues()[0]);
        not_positive += eigen.eigenvalues()[0] > 0.0 ? 0 : 1;
    }
    scan.share_not_positive = static_cast<double>(not_positive) / static_cast<double>(configurations);
    return scan;
}

}  // namespace idim
