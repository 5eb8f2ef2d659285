#include "idim/control_law.hpp"

#include "idim/joint_space.hpp"

namespace idim {

void control_law::tune(const Eigen::VectorXd&) {}

void control_law::limited(const Eigen::VectorXd&, const Eigen::VectorXd&) {}

void control_law::forget() {}

void control_law::reset() {
    late_.clear();
    forget();
}

Eigen::VectorXd control_law::command(const control_sample& sample) {
    const Eigen::VectorXd wanted = unlimited(sample);
    Eigen::VectorXd given = wanted;
    if (saturation.size() > 0) {
        given = wanted.cwiseMax(-saturation).cwiseMin(saturation);
        limited(wanted, given);
    }
    if (delay == 0) {
        return given;
    }
    late_.push_back(std::move(given));
    if (late_.size() <= static_cast<std::size_t>(delay)) {
        return Eigen::VectorXd::Zero(wanted.size());
    }
    Eigen::VectorXd arrived = std::move(late_.front());
    late_.pop_front();
    return arrived;
}

Eigen::VectorXd control_law::torque(const control_sample& sample) {
    return drive_gain.cwiseProduct(command(sample));
}

Eigen::VectorXd largest_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi) {
    constexpr int configurations = 2000;
    joint_space space(model);
    Eigen::MatrixXd M(model.dof, model.dof);
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(model.dof);
    for (int s = 0; s < configurations; ++s) {
        model.mass_matrix(space.next().data(), chi.data(), M.data());
        largest = largest.cwiseMax(M.diagonal());
    }
    return largest;
}

}  // namespace idim
