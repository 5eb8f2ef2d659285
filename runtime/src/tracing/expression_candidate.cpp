#include "expression_candidate.hpp"

#include <cmath>

namespace idim {

namespace {

/// Signals of one joint (and of the one that drives it) along some samples.
struct joint_signals {
    Eigen::VectorXd q, qd, qdd, tau_rigid, t, temp, q_from, qd_from, qdd_from;
    Eigen::MatrixXd state;
};

idim_effect_signals view_of(const joint_signals& s) {
    const auto data = [](const Eigen::VectorXd& signal) { return signal.size() > 0 ? signal.data() : nullptr; };
    idim_effect_signals view{};
    view.count = static_cast<std::size_t>(s.t.size());
    view.q = data(s.q);
    view.qd = data(s.qd);
    view.qdd = data(s.qdd);
    view.tau_rigid = data(s.tau_rigid);
    view.t = data(s.t);
    view.temp = data(s.temp);
    view.q_from = data(s.q_from);
    view.qd_from = data(s.qd_from);
    view.qdd_from = data(s.qdd_from);
    view.state = s.state.size() > 0 ? s.state.data() : nullptr;
    view.state_stride = view.count;
    return view;
}

class catalogue_candidate final : public effect_candidate {
  public:
    catalogue_candidate(const idim_effect& source, int joint, int other) : source_(source) {
        effect = source.name;
        joints = touched = {joint};
        if (other >= 0) {
            from = other;
        }
        if (source.acts_on_both != 0) {
            joints = touched = {joint, other};
            from.reset();
        }
        per_log = source.per_log != 0;
        for (int c = 0; c < source.n_linear; ++c) {
            linear_bound bound{source.linear_names[c], source.linear_units[c]};
            if (!std::isnan(source.linear_min[c])) {
                bound.min = source.linear_min[c];
            }
            linear.push_back(bound);
        }
        for (int s = 0; s < source.n_shape; ++s) {
            shape.push_back({source.shape_names[s], source.shape_units[s], source.shape_low[s], source.shape_high[s]});
        }
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return rows_of(log, joint, columns_of(full_rate(log, joint, at), at));
    }

    Eigen::MatrixXd quick_rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        const joint_signals all = full_rate(log, joint, at);
        const std::vector<Eigen::Index>& kept = log.rows.kept[static_cast<std::size_t>(joint)];
        std::vector<Eigen::Index> places;
        places.reserve(kept.size());
        for (const Eigen::Index k : kept) {
            places.push_back(std::min(k * log.decimation, all.t.size() - 1));
        }
        joint_signals some;
        for (const auto signal :
             {&joint_signals::q, &joint_signals::qd, &joint_signals::qdd, &joint_signals::tau_rigid, &joint_signals::t,
              &joint_signals::temp, &joint_signals::q_from, &joint_signals::qd_from, &joint_signals::qdd_from}) {
            if ((all.*signal).size() > 0) {
                some.*signal = (all.*signal)(places);
            }
        }
        if (all.state.size() > 0) {
            some.state = all.state(places, Eigen::all);
        }
        return columns_of(some, at);
    }

  private:
    /// Signals of the joint whose rows are asked for; in a pair that acts on both the other one drives it.
    joint_signals full_rate(const traced_log& log, int joint, const Eigen::VectorXd& at) const {
        const filtered_samples& samples = log.samples;
        joint_signals s;
        s.t = samples.t;
        s.q = samples.q.col(joint);
        s.qd = samples.qd.col(joint);
        s.qdd = samples.qdd.col(joint);
        s.tau_rigid = log.tau_rigid.col(joint);
        if (samples.temp.size() > 0) {
            s.temp = samples.temp.col(joint);
        }
        const int other = joints.size() > 1 ? (joint == joints[0] ? joints[1] : joints[0]) : from.value_or(-1);
        if (other >= 0) {
            s.q_from = samples.q.col(other);
            s.qd_from = samples.qd.col(other);
            s.qdd_from = samples.qdd.col(other);
        }
        if (source_.n_state > 0) {
            s.state = Eigen::MatrixXd::Zero(samples.samples(), source_.n_state);
            const idim_effect_signals view = view_of(s);
            source_.advance(&view, at.data(), 1.0 / samples.rate, s.state.data(), view.count);
        }
        return s;
    }

    Eigen::MatrixXd columns_of(const joint_signals& signals, const Eigen::VectorXd& at) const {
        Eigen::MatrixXd X = Eigen::MatrixXd::Zero(signals.t.size(), source_.n_linear);
        const idim_effect_signals view = view_of(signals);
        source_.columns(&view, at.data(), X.data(), view.count);
        return X;
    }

    const idim_effect& source_;
};

}  // namespace

candidate_pointer expression_candidate(const idim_effect& effect, int joint, int from) {
    return std::make_shared<catalogue_candidate>(effect, joint, from);
}

}  // namespace idim
