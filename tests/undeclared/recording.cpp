#include "undeclared/recording.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "undeclared/plant.hpp"

namespace idim::undeclared {

namespace {

/// Integrals of signals of the plant's steps, for means over any interval. The torque of step k takes velocities from
/// half a step before t_k to half a step after (plant.hpp), so that is the interval over which it acts.
class running_integral {
  public:
    running_integral(int dof, int steps, double step) : step_(step), sum_(dof, steps + 1) { sum_.col(0).setZero(); }

    void append(const Eigen::VectorXd& value) {
        sum_.col(filled_ + 1) = sum_.col(filled_) + step_ * value;
        ++filled_;
    }
    /// Mean of one joint over [from, until]; constant before the start and after the end.
    double mean(int joint, double from, double until) const {
        return (at(joint, until) - at(joint, from)) / (until - from);
    }

  private:
    double at(int joint, double t) const {
        const double place = t / step_ + 0.5;
        const Eigen::Index k = std::clamp(static_cast<Eigen::Index>(std::floor(place)), Eigen::Index{0}, filled_ - 1);
        return sum_(joint, k) + (place - static_cast<double>(k)) * (sum_(joint, k + 1) - sum_(joint, k));
    }

    double step_;
    Eigen::Index filled_ = 0;
    Eigen::MatrixXd sum_;
};

Eigen::VectorXd effective_inertia(const arm& robot, const joint_scales& scales) {
    Eigen::VectorXd inertia = scales.inertia;
    for (int j = 0; j < robot.dof(); ++j) {
        inertia[j] += robot.drives[static_cast<std::size_t>(j)].rotor_inertia;
    }
    return inertia;
}

/// Each joint warms from 20 degC by 12 to 20 degrees.
class warm_up {
  public:
    warm_up(int dof, double time, sampler random) : time_(time), rise_(dof) {
        for (double& rise : rise_) {
            rise = random.uniform(12.0, 20.0);
        }
    }
    Eigen::VectorXd at(double t) const { return (20.0 + rise_.array() * (1.0 - std::exp(-t / time_))).matrix(); }

  private:
    double time_;
    Eigen::VectorXd rise_;
};

/// Torques of every step of the plant, and what is known at every sample.
struct history {
    running_integral applied, declared;
};

void check(const Eigen::VectorXd& q, const joint_scales& scales) {
    if (!q.allFinite() || (q.cwiseAbs().array() > 3.0 * scales.range.array() + 0.5).any()) {
        throw std::runtime_error("the closed loop is not stable");
    }
}

/// Torque as the drive reports it: over a period around t or as it begins to act, late and scaled where so changed.
void measure_torques(const history& past, const plant_changes& changes, const recording_settings& settings,
                     noise_source& disturbance, recording& made) {
    const double half = 0.5 * (settings.commanded ? settings.step : 1.0 / settings.log_rate);
    for (Eigen::Index k = 0; k < made.t.size(); ++k) {
        Eigen::VectorXd clean(made.q.cols());
        for (int j = 0; j < made.q.cols(); ++j) {
            const double t = made.t[k];
            clean[j] = changes.gain[j] * past.applied.mean(j, t - half - changes.delay[j], t + half - changes.delay[j]);
            made.effect(k, j) = clean[j] - past.declared.mean(j, t - half, t + half);
        }
        made.tau.row(k) = disturbance.disturbed(clean);
        made.torque_noise.row(k) = made.tau.row(k) - clean.transpose();
    }
}

recording empty_recording(Eigen::Index samples, int dof) {
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(samples, dof);
    return {Eigen::VectorXd::Zero(samples), zero, zero, zero, zero, zero, zero, zero};
}

/// A table of numbers, written fast.
class csv_writer {
  public:
    explicit csv_writer(const std::string& file) : name_(file), file_(file, std::ios::binary) {}

    void header(const std::string& text) { line_ = text; }
    void value(double number) {
        char text[32];
        const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 9).ptr;
        line_.append(line_.empty() || line_.back() == '\n' ? "" : ",").append(text, end);
    }
    void end_line() {
        line_ += '\n';
        if (line_.size() > 1 << 16) {
            flush();
        }
    }
    void finish() {
        flush();
        if (!file_.flush()) {
            throw std::runtime_error("cannot write " + name_);
        }
    }

  private:
    void flush() {
        file_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
        line_.clear();
    }

    std::string name_;
    std::ofstream file_;
    std::string line_;
};

}  // namespace

recording record(const arm& robot, const plant_changes& changes, const motion& reference, const joint_scales& scales,
                 const recording_settings& settings, const sampler& random) {
    const int n = robot.dof();
    const auto whole = [](double ratio) { return static_cast<int>(std::lround(ratio)); };
    const int steps_per_control = whole(1.0 / (settings.controller.rate * settings.step));
    const int controls_per_sample = whole(settings.controller.rate / settings.log_rate);
    const int samples = whole(reference.duration() * settings.log_rate);
    recording made = empty_recording(samples, n);
    plant machine(robot, changes, settings.step, settings.regularisation * scales.top_speed);
    joint_controller controller(robot, settings.controller, effective_inertia(robot, scales));
    noise_source encoder(settings.position, settings.controller.rate, random);
    sampler other = random;
    const warm_up heat(n, settings.warm_up_time, sampler("heat", static_cast<std::uint64_t>(other.below(1 << 30))));
    const int steps = samples * controls_per_sample * steps_per_control;
    history past{running_integral(n, steps, settings.step), running_integral(n, steps, settings.step)};
    for (int control = 0; control < samples * controls_per_sample; ++control) {
        const double t = machine.time();
        const reference_point target = reference.at(t);
        const Eigen::VectorXd seen = encoder.disturbed(machine.q());
        const Eigen::VectorXd temperature = heat.at(t);
        if (control % controls_per_sample == 0) {
            const Eigen::Index k = control / controls_per_sample;
            check(machine.q(), scales);
            made.t[k] = static_cast<double>(k) / settings.log_rate;
            made.q.row(k) = seen;
            made.clean_q.row(k) = machine.q();
            made.reference.row(k) = target.q;
            made.temperature.row(k) = temperature;
        }
        const Eigen::VectorXd tau = controller.torque(target, seen);
        for (int i = 0; i < steps_per_control; ++i) {
            machine.advance(tau, temperature);
            past.applied.append(tau);
            past.declared.append(machine.declared_torque());
        }
    }
    noise_source disturbance(settings.torque, settings.log_rate, sampler("torque", other.below(1 << 30)));
    measure_torques(past, changes, settings, disturbance, made);
    return made;
}

void write_log(const std::string& file, const recording& made, const recording_settings& settings,
               bool without_effect) {
    csv_writer writer(file);
    std::string header = "t";
    const auto add_header = [&](const char* name) {
        for (int j = 1; j <= made.q.cols(); ++j) {
            header += std::string(",") + name + std::to_string(j);
        }
    };
    add_header("q");
    add_header("tau");
    if (settings.reference_columns) {
        add_header("qr");
    }
    if (settings.temperature_columns) {
        add_header("temp");
    }
    writer.header(header + "\n");
    const auto add_row = [&](const Eigen::MatrixXd& table, Eigen::Index k) {
        for (Eigen::Index j = 0; j < table.cols(); ++j) {
            writer.value(table(k, j));
        }
    };
    const Eigen::MatrixXd tau = without_effect ? Eigen::MatrixXd(made.tau - made.effect) : made.tau;
    for (Eigen::Index k = 0; k < made.t.size(); ++k) {
        writer.value(made.t[k]);
        add_row(made.q, k);
        add_row(tau, k);
        if (settings.reference_columns) {
            add_row(made.reference, k);
        }
        if (settings.temperature_columns) {
            add_row(made.temperature, k);
        }
        writer.end_line();
    }
    writer.finish();
}

}  // namespace idim::undeclared
