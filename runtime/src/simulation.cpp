#include "idim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "idim/input_error.hpp"
#include "robot_motion.hpp"

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

/// First-order autoregression of Gaussian numbers, stationary from its first value on; white for time = 0.
class coloured_noise {
  public:
    coloured_noise(const Eigen::VectorXd& deviation, Eigen::Index n, double time, double period)
        : deviation_(deviation.size() > 0 ? deviation : Eigen::VectorXd::Zero(n)),
          memory_(time > 0.0 ? std::exp(-period / time) : 0.0) {}

    Eigen::VectorXd operator()(gaussian& random) {
        const Eigen::VectorXd fresh = random(deviation_);
        value_ =
            value_.size() == 0 ? fresh : Eigen::VectorXd(memory_ * value_ + std::sqrt(1.0 - memory_ * memory_) * fresh);
        return value_;
    }

  private:
    Eigen::VectorXd deviation_, value_;
    double memory_;
};

/// What position sensors give.
Eigen::VectorXd quantised(const Eigen::VectorXd& q, const Eigen::VectorXd& resolution) {
    if (resolution.size() == 0) {
        return q;
    }
    return (resolution.array() > 0.0).select(q.cwiseQuotient(resolution).array().round() * resolution.array(), q);
}

/// A signal of the reference at a time, linear between its samples.
Eigen::VectorXd signal_at(const log& reference, const Eigen::MatrixXd& signal, double t) {
    const auto* first = reference.t.data();
    const auto* last = first + reference.t.size();
    const auto after = std::upper_bound(first, last, t) - first;
    const Eigen::Index k = std::clamp<Eigen::Index>(after - 1, 0, reference.t.size() - 2);
    const double share = std::clamp((t - reference.t[k]) / (reference.t[k + 1] - reference.t[k]), 0.0, 1.0);
    return (1.0 - share) * signal.row(k).transpose() + share * signal.row(k + 1).transpose();
}

/// Reference position, speed and acceleration at t.
void follow_reference(const log& reference, double period, control_sample& sample) {
    sample.qr = signal_at(reference, reference.qr, sample.t);
    const Eigen::VectorXd after = signal_at(reference, reference.qr, sample.t + period);
    const Eigen::VectorXd before = signal_at(reference, reference.qr, sample.t - period);
    sample.qdr = reference.qd.size() > 0 ? signal_at(reference, reference.qd, sample.t)
                                         : Eigen::VectorXd((after - before) / (2.0 * period));
    sample.qddr = reference.qdd.size() > 0 ? signal_at(reference, reference.qdd, sample.t)
                                           : Eigen::VectorXd((after - 2.0 * sample.qr + before) / (period * period));
}

void allocate(log& data, Eigen::Index samples, Eigen::Index n, const std::string& name) {
    data.file = name;
    data.t.resize(samples);
    for (Eigen::MatrixXd* signal : {&data.q, &data.tau}) {
        signal->resize(samples, n);
    }
}

/// Keeps the first `samples` of a motion that failed.
void shorten(log& data, Eigen::Index samples) {
    data.t.conservativeResize(samples);
    for (Eigen::MatrixXd* signal : {&data.q, &data.tau, &data.qr, &data.qd, &data.qdd}) {
        if (signal->size() > 0) {
            signal->conservativeResize(samples, Eigen::NoChange);
        }
    }
}

simulated_motion empty_motion(Eigen::Index samples, Eigen::Index n) {
    simulated_motion motion;
    allocate(motion.measured, samples, n, "simulated");
    allocate(motion.truth, samples, n, "simulated without noise");
    motion.measured.qr.resize(samples, n);
    motion.truth.qd.resize(samples, n);
    motion.truth.qdd.resize(samples, n);
    return motion;
}

/// The sensors of one loop, and the random numbers behind them.
class sensors {
  public:
    sensors(const measurement_noise& noise, Eigen::Index n, double period)
        : noise_(noise),
          random_(noise.seed),
          position_(noise.position, n, noise.position_correlation, period),
          torque_(noise.torque, n, noise.torque_correlation, period) {}

    Eigen::VectorXd position(const Eigen::VectorXd& q) { return quantised(q + position_(random_), noise_.resolution); }
    Eigen::VectorXd torque_noise() { return torque_(random_); }
    Eigen::VectorXd velocity(const Eigen::VectorXd& qd) {
        return noise_.velocity.size() == 0 ? qd : Eigen::VectorXd(qd + random_(noise_.velocity));
    }

  private:
    const measurement_noise& noise_;
    gaussian random_;
    coloured_noise position_, torque_;
};

/// The torque as a drive records it that is `delay` [n, s] late; before the first sample it was what it is there.
Eigen::MatrixXd late(const log& clean, const double* delay) {
    Eigen::MatrixXd tau = clean.tau;
    for (Eigen::Index j = 0; j < tau.cols() && delay != nullptr && clean.samples() > 1; ++j) {
        for (Eigen::Index k = 0; k < tau.rows() && delay[j] != 0.0; ++k) {
            tau(k, j) = signal_at(clean, clean.tau, clean.t[k] - delay[j])[j];
        }
    }
    return tau;
}

Eigen::VectorXd either(const Eigen::VectorXd& given, const Eigen::VectorXd& usual) {
    return given.size() > 0 ? given : usual;
}

}  // namespace

Eigen::VectorXd reference_velocity(const log& reference, double period) {
    const double start = reference.t[0];
    return (signal_at(reference, reference.qr, start + period) - signal_at(reference, reference.qr, start)) / period;
}

simulated_motion simulate(const simulated_loop_setup& setup) {
    const log& reference = setup.reference;
    const std::unique_ptr<control_law> law = setup.law.clone();
    law->reset();
    const double period = 1.0 / law->rate;
    const double start = reference.t[0];
    const auto samples = static_cast<Eigen::Index>(std::floor(reference.duration() * law->rate + 1e-9)) + 1;
    const Eigen::Index n = setup.model.dof;
    simulated_motion motion = empty_motion(samples, n);
    sensors seen(setup.noise, n, period);
    robot_motion robot(setup.model, setup.chi, setup.integration,
                       either(setup.start_position, signal_at(reference, reference.qr, start)),
                       either(setup.start_velocity, Eigen::VectorXd::Zero(n)));
    Eigen::MatrixXd torque_noise(samples, n);
    Eigen::VectorXd held;  // torque of the period that ends
    control_sample sample;
    for (Eigen::Index k = 0; k < samples; ++k) {
        sample.t = start + static_cast<double>(k) * period;
        follow_reference(reference, period, sample);
        sample.q = seen.position(robot.q());
        sample.qd = seen.velocity(robot.qd());
        const Eigen::VectorXd tau = law->torque(sample);
        const Eigen::VectorXd qdd = robot.acceleration(sample.t, tau);
        if (!robot.failure()) {
            motion.measured.t[k] = motion.truth.t[k] = sample.t;
            motion.measured.q.row(k) = sample.q;
            motion.measured.tau.row(k) = 0.5 * (either(held, tau) + tau);
            torque_noise.row(k) = seen.torque_noise();
            motion.measured.qr.row(k) = sample.qr;
            motion.truth.q.row(k) = robot.q();
            motion.truth.qd.row(k) = robot.qd();
            motion.truth.qdd.row(k) = qdd;
            motion.truth.tau.row(k) = tau;
            robot.advance(sample.t, period, tau);
        }
        if (robot.failure()) {
            motion.failure = robot.failure();
            const Eigen::Index good = motion.failure->time > sample.t ? k + 1 : k;
            shorten(motion.measured, good);
            shorten(motion.truth, good);
            break;
        }
        held = tau;
    }
    motion.measured.tau =
        late(motion.measured, setup.model.torque_delay) + torque_noise.topRows(motion.measured.samples());
    return motion;
}

simulated_motion simulate(const idim_model_interface& model, const Eigen::VectorXd& chi, const control_law& law,
                          const log& reference, const measurement_noise& noise, int substeps) {
    simulated_loop_setup setup{model, chi, law, reference};
    setup.noise = noise;
    setup.integration.substeps = substeps;
    simulated_motion motion = simulate(setup);
    if (motion.failure) {
        throw data_error(motion.failure->message);
    }
    return motion;
}

}  // namespace idim
