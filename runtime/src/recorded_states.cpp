#include "idim/recorded_states.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "idim/zero_phase_filter.hpp"
#include "links_behind.hpp"

namespace idim {

namespace {

double delay_of(const idim_model_interface& model, int joint) {
    return model.torque_delay == nullptr ? 0.0 : model.torque_delay[joint];
}

/// Whether the model reads anything but motion, time and temperatures.
bool needs_completion(const idim_model_interface& model) {
    return model.n_states > 0 || model.needs_rigid_torque != 0 || has_soft_joint(model);
}

/// Weights of four neighbouring samples at a share of the step between the two in the middle (Lagrange).
std::array<double, 4> cubic_weights(double share) {
    const double before = share + 1.0;
    const double after = 1.0 - share;
    const double last = 2.0 - share;
    return {-share * after * last / 6.0, before * after * last / 2.0, before * share * last / 2.0,
            -before * share * after / 6.0};
}

Eigen::MatrixXd shifted(const Eigen::MatrixXd& values, double samples) {
    const Eigen::Index n = values.rows();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, values.cols());
    const double floor = std::floor(-samples);
    const std::array<double, 4> weights = cubic_weights(-samples - floor);
    for (Eigen::Index k = 0; k < n; ++k) {
        for (int i = 0; i < 4; ++i) {
            const double at = std::clamp(static_cast<double>(k + i - 1) + floor, 0.0, static_cast<double>(n - 1));
            result.row(k) += weights[static_cast<std::size_t>(i)] * values.row(static_cast<Eigen::Index>(at));
        }
    }
    return result;
}

/// Central differences, one-sided at the ends.
Eigen::VectorXd differences(const Eigen::VectorXd& x, double rate) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    if (n > 2) {
        d.segment(1, n - 2) = 0.5 * rate * (x.tail(n - 2) - x.head(n - 2));
        d[0] = rate * (x[1] - x[0]);
        d[n - 1] = rate * (x[n - 1] - x[n - 2]);
    }
    return d;
}

/// A first guess without parameters: the measured torque twists the transmissions. Rotors and links could not be told
/// apart if they moved alike.
void follow_measured_torque(const idim_model_interface& model, const filtered_samples& motor, filtered_samples& link) {
    constexpr int order = 6;
    constexpr double part_of_nyquist = 0.05;  // derivatives of measured torques are of use at low frequencies only
    const second_order_sections filter = butterworth_lowpass(order, part_of_nyquist);
    if (motor.samples() <= padding(filter)) {
        return;
    }
    for (const soft_transmission& t : transmissions_of(model)) {
        const Eigen::VectorXd angle = zero_phase_filter(filter, motor.tau.col(t.joint)) / t.stiffness;
        const Eigen::VectorXd rate = differences(angle, motor.rate);
        link.q.col(t.joint) -= angle;
        link.qd.col(t.joint) -= rate;
        link.qdd.col(t.joint) -= differences(rate, motor.rate);
    }
}

/// Runs the states along the samples; `signals` holds everything else.
void run_states(const idim_model_interface& model, const filtered_samples& samples, Eigen::MatrixXd& signals) {
    const auto states = Eigen::seqN(Eigen::Index{model.dof}, Eigen::Index{model.n_states});
    Eigen::VectorXd state(model.n_states);
    for (Eigen::Index k = 0; k < samples.samples(); ++k) {
        const Eigen::VectorXd q = samples.q.row(k);
        const Eigen::VectorXd qd = samples.qd.row(k);
        const Eigen::VectorXd qdd = samples.qdd.row(k);
        if (k == 0) {
            const Eigen::VectorXd at = signals.row(k);
            model.first_states(q.data(), qd.data(), qdd.data(), samples.t[k], at.data(), state.data());
        }
        signals(k, states) = state.transpose();
        const Eigen::VectorXd at = signals.row(k);
        model.next_states(q.data(), qd.data(), qdd.data(), samples.t[k], at.data(), 1.0 / samples.rate, state.data());
    }
}

/// The motion of the links, with what effects read beside it in the place of the temperatures.
filtered_samples with_signals(const idim_model_interface& model, const filtered_samples& motors, filtered_samples links,
                              const Eigen::VectorXd& chi) {
    const Eigen::Index n = model.dof;
    Eigen::MatrixXd signals = Eigen::MatrixXd::Zero(motors.samples(), model.n_signals);
    if (motors.temp.size() > 0) {
        signals.leftCols(n) = motors.temp;
    }
    Eigen::Index place = n + model.n_states;
    if (has_soft_joint(model)) {
        signals.middleCols(place, 3 * n) << motors.q, motors.qd, motors.qdd;
        place += 3 * n;
    }
    if (model.needs_rigid_torque != 0 && chi.size() > 0) {
        signals.middleCols(place, n) = rigid_torques(model, links, chi);
    } else if (model.needs_rigid_torque != 0 && motors.tau.size() > 0) {
        signals.middleCols(place, n) = motors.tau;
    }
    if (model.n_states > 0) {
        run_states(model, links, signals);
    }
    links.temp = std::move(signals);
    return links;
}

/// Torques of all joints along samples that hold everything the model reads, samples x n.
Eigen::MatrixXd torques_along(const idim_model_interface& model, const filtered_samples& at,
                              const Eigen::VectorXd& chi) {
    const auto count = static_cast<std::size_t>(at.samples());
    const idim_samples block = {count,
                                count,
                                at.q.data(),
                                at.qd.data(),
                                at.qdd.data(),
                                at.t.data(),
                                at.temp.size() > 0 ? at.temp.data() : nullptr};
    Eigen::MatrixXd all(at.samples(), model.dof);
    model.inverse_dynamics_batch(&block, chi.data(), all.data(), count);
    return all;
}

}  // namespace

double stiffness_of(const idim_model_interface& model, int joint) {
    return model.joint_stiffness == nullptr ? 0.0 : model.joint_stiffness[joint];
}

double damping_of(const idim_model_interface& model, int joint) {
    return model.joint_damping == nullptr ? 0.0 : model.joint_damping[joint];
}

bool has_soft_joint(const idim_model_interface& model) {
    bool soft = false;
    for (int j = 0; j < model.dof; ++j) {
        soft = soft || stiffness_of(model, j) > 0.0;
    }
    return soft;
}

bool depends_on_parameters(const idim_model_interface& model) {
    return model.needs_rigid_torque != 0 || has_soft_joint(model);
}

filtered_samples earlier(const filtered_samples& samples, double shift) {
    filtered_samples result = samples;
    result.t.array() -= shift;
    for (const auto signal :
         {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd, &filtered_samples::temp}) {
        if ((samples.*signal).size() > 0) {
            result.*signal = shifted(samples.*signal, shift * samples.rate);
        }
    }
    return result;
}

filtered_samples completed(const idim_model_interface& model, const filtered_samples& samples,
                           const Eigen::VectorXd& chi) {
    filtered_samples links = samples;
    if (has_soft_joint(model) && chi.size() > 0) {
        const links_torque torque = [&](const filtered_samples& at) { return rigid_torques(model, at, chi); };
        const lacking_torque lacking = [&](const filtered_samples& motors, const filtered_samples& at) {
            return Eigen::MatrixXd(motors.tau - torques_along(model, with_signals(model, motors, at, chi), chi));
        };
        links =
            links_behind(samples, transmissions_of(model), torque, samples.tau.size() > 0 ? lacking : lacking_torque());
    } else if (has_soft_joint(model) && samples.tau.size() > 0) {
        follow_measured_torque(model, samples, links);
    }
    return with_signals(model, samples, std::move(links), chi);
}

recorded_states::recorded_states(const idim_model_interface& model, const filtered_samples& samples,
                                 const Eigen::VectorXd& chi)
    : measured_(samples) {
    std::vector<double> delays;
    for (int j = 0; j < model.dof; ++j) {
        const double delay = delay_of(model, j);
        if (delay == 0.0 && !needs_completion(model)) {
            place_.push_back(-1);
            continue;
        }
        const auto known = std::find(delays.begin(), delays.end(), delay);
        place_.push_back(static_cast<int>(known - delays.begin()));
        if (known == delays.end()) {
            delays.push_back(delay);
            const filtered_samples before = delay == 0.0 ? samples : earlier(samples, delay);
            states_.push_back(needs_completion(model) ? completed(model, before, chi) : before);
        }
    }
}

const filtered_samples& recorded_states::of(int joint) const {
    const int place = place_[static_cast<std::size_t>(joint)];
    return place < 0 ? measured_ : states_[static_cast<std::size_t>(place)];
}

Eigen::MatrixXd model_torques(const idim_model_interface& model, const filtered_samples& samples,
                              const Eigen::VectorXd& chi) {
    const recorded_states states(model, samples, chi);
    Eigen::MatrixXd torques(samples.samples(), model.dof);
    const filtered_samples* last = nullptr;
    Eigen::MatrixXd all;
    for (int j = 0; j < model.dof; ++j) {
        if (const filtered_samples& at = states.of(j); &at != last) {
            all = torques_along(model, at, chi);
            last = &at;
        }
        torques.col(j) = all.col(j);
    }
    return torques;
}

}  // namespace idim
