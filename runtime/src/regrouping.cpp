#include "regrouping.hpp"

namespace idim {

Eigen::MatrixXd regrouping_of(const idim_model_interface& model) {
    Eigen::MatrixXd R(model.n_base, model.n_standard);
    for (Eigen::Index p = 0; p < R.cols(); ++p) {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(R.cols(), p);
        model.regroup(unit.data(), R.col(p).data());
    }
    return R;
}

}  // namespace idim
