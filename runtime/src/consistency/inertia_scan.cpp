#include <Eigen/Eigenvalues>
#include <limits>

#include "idim/consistent_fit.hpp"
#include "idim/joint_space.hpp"

namespace idim {

inertia_scan scan_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi, int configurations) {
    joint_space space(model);
    Eigen::MatrixXd M(model.dof, model.dof);
    inertia_scan scan;
    scan.configurations = configurations;
    scan.smallest = std::numeric_limits<double>::infinity();
    int not_positive = 0;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(model.dof);
    for (int s = 0; s < configurations; ++s) {
        model.mass_matrix(space.next().data(), chi.data(), M.data());
        // Rows that a gain error scales make M unsymmetric.
        eigen.compute(0.5 * (M + M.transpose()), Eigen::EigenvaluesOnly);
        scan.smallest = std::min(scan.smallest, eigen.eigenvalues()[0]);
        not_positive += eigen.eigenvalues()[0] > 0.0 ? 0 : 1;
    }
    scan.share_not_positive = static_cast<double>(not_positive) / static_cast<double>(configurations);
    return scan;
}

}  // namespace idim
