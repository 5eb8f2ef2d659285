#include "idim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "idim/input_error.hpp"

namespace idim {

namespace {

/// Gaussian numbers that are the same with every standard library (Box and Muller 1958).
class gaussian {
  public:
    explicit gaussian(std::uint64_t seed) : random_(seed) {}

    Eigen::VectorXd operator()(const Eigen::VectorXd& deviation) {
        Eigen::VectorXd value(deviation.size());
        for (Eigen::Index i = 0; i < value.size(); ++i) {
            const double u = (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53;
            const double v = static_cast<double>(random_() >> 11) * 0x1p-53;
            value[i] = deviation[i] * std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
        }
        return value;
    }

  private:
    std::mt19937_64 random_;
};

/// Position and velocity under a torque that is held.
class plant {
  public:
    plant(const idim_model_interface& model, const Eigen::VectorXd& chi, const Eigen::VectorXd& q)
        : model_(model),
          chi_(chi),
          signals_(Eigen::VectorXd::Zero(std::max(model.dof, model.n_signals))),
          q_(q),
          qd_(Eigen::VectorXd::Zero(model.dof)),
          qdd_(Eigen::VectorXd::Zero(model.dof)) {
        signals_.head(model.dof).setConstant(20.0);  // degC
    }

    /// States of effects as a motion starts.
    void start(double t) {
        if (model_.n_states > 0) {
            Eigen::VectorXd first(model_.n_states);
            set_motor();
            model_.first_states(q_.data(), qd_.data(), qdd_.data(), t, signals_.data(), first.data());
            signals_.segment(model_.dof, model_.n_states) = first;
        }
    }

    const Eigen::VectorXd& q() const { return q_; }
    const Eigen::VectorXd& qd() const { return qd_; }

    Eigen::VectorXd acceleration(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                 const Eigen::VectorXd& tau) const {
        Eigen::VectorXd qdd(model_.dof);
        const int joint =
            model_.forward_dynamics(q.data(), qd.data(), tau.data(), t, signals_.data(), chi_.data(), qdd.data());
        if (joint == IDIM_NOT_CONVERGED) {
            throw data_error(
                fmt::format("simulation at t = {:.4f} s: no accelerations give the torque; effects of the "
                            "torque of the links are too strong",
                            t));
        }
        if (joint != 0) {
            throw data_error(
                fmt::format("simulation at t = {:.4f} s: the inertia matrix is not positive definite at joint {}; the "
                            "parameters are not physical",
                            t, model_.joint_names[joint - 1]));
        }
        return qdd;
    }

    void step(double t, double h, const Eigen::VectorXd& tau) {
        const Eigen::VectorXd a1 = acceleration(t, q_, qd_, tau);
        const Eigen::VectorXd v2 = qd_ + 0.5 * h * a1;
        const Eigen::VectorXd a2 = acceleration(t + 0.5 * h, q_ + 0.5 * h * qd_, v2, tau);
        const Eigen::VectorXd v3 = qd_ + 0.5 * h * a2;
        const Eigen::VectorXd a3 = acceleration(t + 0.5 * h, q_ + 0.5 * h * v2, v3, tau);
        const Eigen::VectorXd v4 = qd_ + h * a3;
        const Eigen::VectorXd a4 = acceleration(t + h, q_ + h * v3, v4, tau);
        q_ += h / 6.0 * (qd_ + 2.0 * v2 + 2.0 * v3 + v4);
        qd_ += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        check(t + h);
        qdd_ = a1;
        advance(t, h);
    }

  private:
    void advance(double t, double h) {
        if (model_.n_states > 0) {
            Eigen::VectorXd next(model_.n_states);
            set_motor();
            model_.next_states(q_.data(), qd_.data(), qdd_.data(), t, signals_.data(), h, next.data());
            signals_.segment(model_.dof, model_.n_states) = next;
        }
    }

    /// The simulated transmissions are rigid: the motors move with the links.
    void set_motor() {
        const Eigen::Index n = model_.dof;
        const Eigen::Index first = n + model_.n_states;
        if (signals_.size() >= first + 3 * n && model_.joint_stiffness != nullptr) {
            signals_.segment(first, 3 * n) << q_, qd_, qdd_;
        }
    }

    void check(double t) const {
        constexpr double fastest = 1e4;  // rad/s or m/s: no robot moves like that
        for (int j = 0; j < model_.dof; ++j) {
            if (!(std::abs(qd_[j]) < fastest)) {
                throw data_error(fmt::format(
                    "simulation diverges at t = {:.4f} s, joint {}: lower the bandwidth or raise the rate of "
                    "the control law",
                    t, model_.joint_names[j]));
            }
        }
    }

    const idim_model_interface& model_;
    const Eigen::VectorXd& chi_;
    Eigen::VectorXd signals_;  ///< as model_interface.h orders them
    Eigen::VectorXd q_, qd_, qdd_;
};

/// Reference position at a time, linear between its samples.
Eigen::VectorXd reference_at(const log& reference, double t) {
    const auto* first = reference.t.data();
    const auto* last = first + reference.t.size();
    const auto after = std::upper_bound(first, last, t) - first;
    const Eigen::Index k = std::clamp<Eigen::Index>(after - 1, 0, reference.t.size() - 2);
    const double share = std::clamp((t - reference.t[k]) / (reference.t[k + 1] - reference.t[k]), 0.0, 1.0);
    return (1.0 - share) * reference.qr.row(k).transpose() + share * reference.qr.row(k + 1).transpose();
}

void allocate(log& data, Eigen::Index samples, Eigen::Index n, const std::string& name) {
    data.file = name;
    data.t.resize(samples);
    for (Eigen::MatrixXd* signal : {&data.q, &data.tau}) {
        signal->resize(samples, n);
    }
}

}  // namespace

simulated_motion simulate(const idim_model_interface& model, const Eigen::VectorXd& chi, const pd_cascade& law,
                          const log& reference, const measurement_noise& noise, int substeps) {
    const double period = 1.0 / law.rate;
    const double start = reference.t[0];
    const auto samples = static_cast<Eigen::Index>(std::floor(reference.duration() * law.rate + 1e-9)) + 1;
    const Eigen::Index n = model.dof;
    simulated_motion motion;
    allocate(motion.measured, samples, n, "simulated");
    allocate(motion.truth, samples, n, "simulated without noise");
    motion.measured.qr.resize(samples, n);
    motion.truth.qd.resize(samples, n);
    motion.truth.qdd.resize(samples, n);

    gaussian random(noise.seed);
    Eigen::VectorXd held;  // torque of the period that ends
    plant robot(model, chi, reference_at(reference, start));
    robot.start(start);
    for (Eigen::Index k = 0; k < samples; ++k) {
        const double t = start + static_cast<double>(k) * period;
        const Eigen::VectorXd qr = reference_at(reference, t);
        const Eigen::VectorXd q = robot.q() + random(noise.position);
        const Eigen::VectorXd tau = law.torque(qr, q, robot.qd());
        motion.measured.t[k] = motion.truth.t[k] = t;
        motion.measured.q.row(k) = q;
        held = k == 0 ? tau : held;
        motion.measured.tau.row(k) = 0.5 * (held + tau) + random(noise.torque);
        held = tau;
        motion.measured.qr.row(k) = qr;
        motion.truth.q.row(k) = robot.q();
        motion.truth.qd.row(k) = robot.qd();
        motion.truth.qdd.row(k) = robot.acceleration(t, robot.q(), robot.qd(), tau);
        motion.truth.tau.row(k) = tau;
        for (int s = 0; s < substeps; ++s) {
            robot.step(t + s * period / substeps, period / substeps, tau);
        }
    }
    return motion;
}

}  // namespace idim
