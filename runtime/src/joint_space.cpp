#include "idim/joint_space.hpp"

#include <numbers>

namespace idim {

bool loops_close(const idim_model_interface& model, const double* q, double least) {
    if (model.n_closures == 0) {
        return true;
    }
    Eigen::VectorXd closed(model.n_closures);
    model.closure(q, closed.data());
    return (closed.array() > least).all();
}

joint_space::joint_space(const idim_model_interface& model) : model_(model), q_(Eigen::VectorXd::Zero(model.dof)) {}

const Eigen::VectorXd& joint_space::next() {
    constexpr int most_tries = 100000;
    constexpr double least = 0.25;  // squared sine
    for (int k = 0; k < most_tries; ++k) {
        draw();
        if (loops_close(model_, q_.data(), least)) {
            break;
        }
    }
    return q_;
}

void joint_space::draw() {
    for (int j = 0; j < model_.dof; ++j) {
        const double uniform = static_cast<double>(random_() >> 11) * 0x1p-52 - 1.0;
        q_[j] = at_zero_ ? 0.0 : (model_.joint_is_prismatic[j] != 0 ? uniform : std::numbers::pi * uniform);
    }
    at_zero_ = false;
}

}  // namespace idim
