#include "model_candidates.hpp"

#include <algorithm>
#include <utility>

namespace idim {

namespace {

/// Values of the samples `shift` seconds earlier, the first one before the start: a cubic through four neighbours, for
/// a line between two of them would smooth as well as shift, and smoothing looks like a second derivative.
Eigen::VectorXd earlier(const Eigen::Ref<const Eigen::VectorXd>& values, double shift, double rate) {
    const Eigen::Index last = values.size() - 1;
    const auto at = [&](Eigen::Index k) { return values[std::clamp<Eigen::Index>(k, 0, last)]; };
    Eigen::VectorXd moved(values.size());
    for (Eigen::Index k = 0; k <= last; ++k) {
        const double place = std::clamp(static_cast<double>(k) - shift * rate, 0.0, static_cast<double>(last));
        const auto below = static_cast<Eigen::Index>(place);
        const double u = place - static_cast<double>(below);
        moved[k] = -u * (u - 1.0) * (u - 2.0) / 6.0 * at(below - 1) + (u * u - 1.0) * (u - 2.0) / 2.0 * at(below) -
                   u * (u + 1.0) * (u - 2.0) / 2.0 * at(below + 1) + u * (u * u - 1.0) / 6.0 * at(below + 2);
    }
    return moved;
}

class delayed_torque final : public effect_candidate {
  public:
    delayed_torque(std::vector<int> all, double at, linear_bound bound) : at_(at) {
        effect = "torque_delay";
        joints = all;
        touched = std::move(all);
        linear = {std::move(bound)};
        role = column_role::shape;
    }
    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd&) const override {
        const auto tau = log.tau_model.col(joint);
        return rows_of(log, joint, (earlier(tau, at_, log.samples.rate) - tau) / at_);
    }
    candidate_pointer relinearised(const Eigen::VectorXd& found) const override {
        return found[0] != 0.0 ? std::make_shared<delayed_torque>(joints, found[0], linear.front()) : nullptr;
    }

  private:
    double at_;
};

class scaled_torque final : public effect_candidate {
  public:
    explicit scaled_torque(int joint) {
        effect = "drive_gain_error";
        joints = touched = {joint};
        linear = {{"Ke", "1"}};
        role = column_role::shape;
    }
    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd&) const override {
        return rows_of(log, joint, log.tau_model.col(joint));
    }
    candidate_pointer relinearised(const Eigen::VectorXd& /*found*/) const override {
        return std::make_shared<scaled_torque>(joints.front());
    }
};

}  // namespace

candidate_pointer delay_candidate(int joint, double at, double period) {
    return std::make_shared<delayed_torque>(std::vector<int>{joint}, at, linear_bound{"Td", "s", 0.0, period});
}

candidate_pointer alignment_candidate(int joints, double at) {
    std::vector<int> all;
    for (int j = 0; j < joints; ++j) {
        all.push_back(j);
    }
    return std::make_shared<delayed_torque>(std::move(all), at, linear_bound{"Td", "s"});
}

candidate_pointer gain_candidate(int joint) {
    return std::make_shared<scaled_torque>(joint);
}

}  // namespace idim
