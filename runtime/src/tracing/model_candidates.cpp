#include "model_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace idim {

namespace {

/// Values of the samples `shift` seconds earlier, linear between samples, the first one before the start.
Eigen::VectorXd earlier(const Eigen::Ref<const Eigen::VectorXd>& values, double shift, double rate) {
    const Eigen::Index last = values.size() - 1;
    Eigen::VectorXd moved(values.size());
    for (Eigen::Index k = 0; k <= last; ++k) {
        const double place = std::clamp(static_cast<double>(k) - shift * rate, 0.0, static_cast<double>(last));
        const auto below = std::min(static_cast<Eigen::Index>(place), std::max<Eigen::Index>(0, last - 1));
        const double share = place - static_cast<double>(below);
        moved[k] = (1.0 - share) * values[below] + share * values[std::min(below + 1, last)];
    }
    return moved;
}

class delayed_torque final : public effect_candidate {
  public:
    delayed_torque(std::vector<int> all, double at, double period) : at_(at), period_(period) {
        effect = "torque_delay";
        joints = all;
        touched = std::move(all);
        linear = {{"Td", "s", -std::numeric_limits<double>::infinity(), period}};
        role = column_role::shape;
    }
    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd&) const override {
        const auto tau = log.tau_model.col(joint);
        return rows_of(log, joint, (earlier(tau, at_, log.samples.rate) - tau) / at_);
    }
    candidate_pointer relinearised(const Eigen::VectorXd& found) const override {
        return found[0] != 0.0 ? std::make_shared<delayed_torque>(joints, found[0], period_) : nullptr;
    }

  private:
    double at_;
    double period_;
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

/// Central differences along the samples, one-sided at the ends.
Eigen::VectorXd differentiated(const Eigen::Ref<const Eigen::VectorXd>& x, double rate) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    if (n > 2) {
        d.segment(1, n - 2) = (x.tail(n - 2) - x.head(n - 2)) * (0.5 * rate);
        d[0] = d[1];
        d[n - 1] = d[n - 2];
    }
    return d;
}

class soft_transmission final : public effect_candidate {
  public:
    soft_transmission(const idim_model_interface& model, Eigen::VectorXd rigid, int joint, double at)
        : model_(model), rigid_(std::move(rigid)), joint_(joint), at_(at) {
        effect = "joint_elasticity";
        joints = {joint};
        for (int j = 0; j < model.dof; ++j) {
            touched.push_back(j);
        }
        linear = {{"K", "N*m/rad", 0.0}};
        role = column_role::shape;
    }
    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd&) const override {
        const filtered_samples& motor = log.samples;
        const auto count = static_cast<std::size_t>(motor.samples());
        const Eigen::VectorXd twist = at_ * log.tau_rigid.col(joint_);
        const Eigen::VectorXd twist_rate = differentiated(twist, motor.rate);
        Eigen::MatrixXd q = motor.q;
        Eigen::MatrixXd qd = motor.qd;
        Eigen::MatrixXd qdd = motor.qdd;
        const Eigen::VectorXd twist_acceleration = differentiated(twist_rate, motor.rate);
        q.col(joint_) -= twist;
        qd.col(joint_) -= twist_rate;
        qdd.col(joint_) -= twist_acceleration;
        const idim_samples link = {count,
                                   count,
                                   q.data(),
                                   qd.data(),
                                   qdd.data(),
                                   motor.t.data(),
                                   motor.temp.size() > 0 ? motor.temp.data() : nullptr};
        Eigen::MatrixXd tau(motor.samples(), model_.dof);
        model_.inverse_dynamics_batch(&link, rigid_.data(), tau.data(), count);
        return rows_of(log, joint, (tau.col(joint) - log.tau_rigid.col(joint)) / at_);
    }
    std::pair<double, double> declared(double compliance, double deviation) const override {
        return {1.0 / compliance, deviation / (compliance * compliance)};
    }
    candidate_pointer relinearised(const Eigen::VectorXd& found) const override {
        return found[0] > 0.0 ? std::make_shared<soft_transmission>(model_, rigid_, joint_, found[0]) : nullptr;
    }

  private:
    const idim_model_interface& model_;
    Eigen::VectorXd rigid_;
    int joint_;
    double at_;
};

}  // namespace

candidate_pointer delay_candidate(int joint, double at, double period) {
    return std::make_shared<delayed_torque>(std::vector<int>{joint}, at, period);
}

candidate_pointer alignment_candidate(int joints, double at) {
    std::vector<int> all;
    for (int j = 0; j < joints; ++j) {
        all.push_back(j);
    }
    return std::make_shared<delayed_torque>(std::move(all), at, 0.0);
}

candidate_pointer gain_candidate(int joint) {
    return std::make_shared<scaled_torque>(joint);
}

candidate_pointer elasticity_candidate(const idim_model_interface& model, const Eigen::VectorXd& chi, int joint,
                                       double at) {
    return std::make_shared<soft_transmission>(model, rigid_part(model, chi), joint, at);
}

}  // namespace idim
