#include "model_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "idim/power_spectrum.hpp"
#include "idim/zero_phase_filter.hpp"

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

/// Where the second derivative of a signal sinks into its noise [Hz]: the lowest point of its spectrum, means over half
/// octaves, above the band of the signal itself; none where the spectrum does not rise fourfold again.
std::optional<double> noise_begins(const Eigen::VectorXd& signal, double rate) {
    constexpr double visible_rise = 4.0;
    const Eigen::Index segment = welch_segment(signal.size());
    const power_spectrum second = welch_spectrum(differentiated(differentiated(signal, rate), rate), rate, segment);
    const double step = std::exp2(0.25);
    double lowest = std::numeric_limits<double>::infinity();
    std::optional<double> valley;
    for (double f = energy_frequency(welch_spectrum(signal, rate, segment), 0.99, 0.5 * rate); f * step < 0.4 * rate;
         f *= step) {
        const Eigen::ArrayXd near = (second.frequency > f / step && second.frequency < f * step).cast<double>();
        const double level = near.sum() > 0.0 ? (near * second.density).sum() / near.sum() : lowest;
        if (level < lowest) {
            lowest = level;
            valley = f;
        } else if (level > visible_rise * lowest) {
            return valley;
        }
    }
    return std::nullopt;
}

/// The signal without what its second derivative shows of noise alone: a column made of noise would be fitted to the
/// torque that the controller gives in answer to that noise.
Eigen::VectorXd without_noise(const Eigen::VectorXd& signal, double rate) {
    constexpr int order = 4;
    constexpr Eigen::Index shortest = 64;  // samples, for a spectrum
    const std::optional<double> cutoff = signal.size() < shortest ? std::nullopt : noise_begins(signal, rate);
    return cutoff ? Eigen::VectorXd(zero_phase_filter(butterworth_lowpass(order, *cutoff / (0.5 * rate)), signal))
                  : signal;
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
    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return touched_rows(log, at)[static_cast<std::size_t>(joint)];
    }
    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd&) const override {
        const filtered_samples& motor = log.samples;
        const auto count = static_cast<std::size_t>(motor.samples());
        const Eigen::VectorXd twist = at_ * without_noise(log.tau_rigid.col(joint_), motor.rate);
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
        std::vector<Eigen::MatrixXd> columns;
        for (const int joint : touched) {
            columns.push_back(rows_of(log, joint, (tau.col(joint) - log.tau_rigid.col(joint)) / at_));
        }
        return columns;
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

candidate_pointer elasticity_candidate(const idim_model_interface& model, const Eigen::VectorXd& chi, int joint,
                                       double at) {
    return std::make_shared<soft_transmission>(model, rigid_part(model, chi), joint, at);
}

}  // namespace idim
