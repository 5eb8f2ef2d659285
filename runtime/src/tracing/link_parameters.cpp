#include "link_parameters.hpp"

#include <string>

namespace idim {

Eigen::MatrixXd link_columns(const idim_model_interface& model, const Eigen::MatrixXd& regrouping, int joint) {
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(model.n_base, static_cast<Eigen::Index>(inertial_names.size()));
    for (std::size_t c = 0; c < inertial_names.size(); ++c) {
        const std::string name = inertial_names[c] + std::to_string(joint + 1);
        for (int s = 0; s < model.n_standard; ++s) {
            if (name == model.standard_names[s]) {
                B.col(static_cast<Eigen::Index>(c)) = regrouping.col(s);
            }
        }
    }
    return B;
}

}  // namespace idim
