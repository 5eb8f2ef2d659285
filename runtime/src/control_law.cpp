#include "idim/control_law.hpp"

#include <cmath>
#include <numbers>
#include <random>

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

}  // namespace idim
