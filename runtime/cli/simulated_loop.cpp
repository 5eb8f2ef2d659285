#include "simulated_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "description/robot_description.hpp"
#include "idim/control_law.hpp"
#include "idim/input_error.hpp"
#include "idim/simulation.hpp"
#include "idim/zero_phase_filter.hpp"

namespace idim::cli {

namespace {

constexpr int substeps = 4;  // of the sampling period: the instruments change by less than 1e-5 with more

/// A cascade PD by its natural frequency and damping, the gains for any inertia [IV 44-46].
struct cascade {
    double rate = 0.0;
    Eigen::VectorXd natural_frequency, damping, drive_gain, saturation;

    pd_cascade law(const Eigen::VectorXd& inertia) const {
        pd_cascade tuned = tune_pd_cascade(rate, natural_frequency, damping, inertia, drive_gain);
        tuned.saturation = saturation;
        return tuned;
    }
};

Eigen::VectorXd drive_gains(const idim_model_interface& model) {
    Eigen::VectorXd gain(model.dof);
    for (int j = 0; j < model.dof; ++j) {
        gain[j] = model.drive_gain[j] != 0.0 ? model.drive_gain[j] : 1.0;
    }
    return gain;
}

/// Cubic interpolation of the positions at other times; their own values at their own times.
Eigen::MatrixXd positions_at(const idim::log& motion, const Eigen::VectorXd& t) {
    Eigen::MatrixXd q(t.size(), motion.q.cols());
    Eigen::Index k = 0;
    for (Eigen::Index i = 0; i < t.size(); ++i) {
        while (k + 2 < motion.t.size() && motion.t[k + 1] <= t[i]) {
            ++k;
        }
        const double h = motion.t[k + 1] - motion.t[k];
        const double s = std::clamp((t[i] - motion.t[k]) / h, 0.0, 1.0);
        const double rest = 1.0 - s;
        q.row(i) = rest * rest * ((1.0 + 2.0 * s) * motion.q.row(k) + s * h * motion.qd.row(k)) +
                   s * s * ((1.0 + 2.0 * rest) * motion.q.row(k + 1) - rest * h * motion.qd.row(k + 1));
    }
    return q;
}

/// Linear interpolation; their own values at their own times.
Eigen::MatrixXd values_at(const Eigen::VectorXd& from, const Eigen::MatrixXd& values, const Eigen::VectorXd& t) {
    Eigen::MatrixXd result(t.size(), values.cols());
    Eigen::Index k = 0;
    for (Eigen::Index i = 0; i < t.size(); ++i) {
        while (k + 2 < from.size() && from[k + 1] <= t[i]) {
            ++k;
        }
        const double s = std::clamp((t[i] - from[k]) / (from[k + 1] - from[k]), 0.0, 1.0);
        result.row(i) = (1.0 - s) * values.row(k) + s * values.row(k + 1);
    }
    return result;
}

idim::log follow(const idim_model_interface& model, const Eigen::VectorXd& chi, const pd_cascade& law,
                 const idim::log& reference) {
    const Eigen::VectorXd quiet = Eigen::VectorXd::Zero(model.dof);
    const simulated_motion simulated = simulate(model, chi, law, reference, {quiet, quiet, 1}, substeps);
    idim::log motion;
    motion.t = reference.t;
    motion.q = positions_at(simulated.truth, reference.t);
    motion.tau = values_at(simulated.measured.t, simulated.measured.tau, reference.t);
    return motion;
}

/// The measured position as a reference for a cascade: low-passed like the rows, and advanced by qd / kp, so that the
/// loop's velocity feedback acts on the velocity error alone.
Eigen::MatrixXd tracked_reference(const idim::log& recorded, const filter_choice& filter, const cascade& loop) {
    const double rate = static_cast<double>(recorded.samples() - 1) / recorded.duration();
    Eigen::MatrixXd q = recorded.q;
    if (filter.cutoff > 0.0) {
        q = zero_phase_filter(butterworth_lowpass(filter.order, filter.cutoff / (0.5 * rate)), q);
    }
    Eigen::MatrixXd qd = Eigen::MatrixXd::Zero(q.rows(), q.cols());
    const Eigen::Index inner = q.rows() - 2;
    qd.middleRows(1, inner) = (q.bottomRows(inner) - q.topRows(inner)) * (0.5 * rate);
    const Eigen::VectorXd lead = 2.0 * loop.damping.cwiseQuotient(loop.natural_frequency);
    return q + qd * lead.asDiagonal();
}

using reference_maker = std::function<idim::log(const idim::log& recorded)>;

simulated_loops loops_of(const idim_model_interface& model, const cascade& loop, const Eigen::VectorXd& a_priori,
                         const reference_maker& reference, const std::string& assumption) {
    const pd_cascade own = loop.law(largest_inertia(model, a_priori));
    simulated_loops loops;
    loops.rescaled = {[&model, loop, reference](const Eigen::VectorXd& chi, const idim::log& recorded) {
                          return follow(model, chi, loop.law(largest_inertia(model, chi)), reference(recorded));
                      },
                      loop.natural_frequency, assumption};
    loops.fixed = {[&model, own, reference](const Eigen::VectorXd& chi, const idim::log& recorded) {
                       return follow(model, chi, own, reference(recorded));
                   },
                   loop.natural_frequency, assumption};
    return loops;
}

/// Natural frequency and damping of the declared law; from its gains with the inertia of `a_priori` [IV 43].
cascade declared_cascade(const generator::control_description& control, const idim_model_interface& model,
                         const Eigen::VectorXd& a_priori) {
    const auto values = [&](const std::string& name) -> Eigen::VectorXd {
        const auto found = control.values.find(name);
        if (found == control.values.end()) {
            throw input_error(control.where, "expected " + name + ", or wn and zeta, one number per joint");
        }
        const std::vector<double>& given = found->second;
        if (given.size() != 1 && given.size() != static_cast<std::size_t>(model.dof)) {
            throw input_error(control.where,
                              fmt::format("{}: {} values given, expected 1 or {}", name, given.size(), model.dof));
        }
        return given.size() == 1 ? Eigen::VectorXd::Constant(model.dof, given.front())
                                 : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(given.data(), model.dof));
    };
    cascade loop{control.rate, {}, {}, drive_gains(model), {}};
    if (control.values.count("wn") != 0) {
        loop.natural_frequency = values("wn");
        loop.damping = values("zeta");
    } else {
        const Eigen::VectorXd inertia = largest_inertia(model, a_priori);
        const Eigen::ArrayXd kv = values("kv").cwiseProduct(loop.drive_gain);
        const Eigen::ArrayXd kp = values("kp");
        loop.natural_frequency = (kp * kv / inertia.array()).sqrt();
        loop.damping = 0.5 * (kv / (kp * inertia.array())).sqrt();
    }
    if (control.values.count("saturation") != 0) {
        loop.saturation = values("saturation");
    }
    return loop;
}

simulated_loops tracking_loops(const idim_model_interface& model, const std::vector<idim::log>& logs,
                               const filter_choice& filter, const loop_request& request,
                               const Eigen::VectorXd& a_priori, const std::string& why) {
    const double rate = static_cast<double>(logs.front().samples() - 1) / logs.front().duration();
    const double bandwidth = request.bandwidth.value_or(std::min(filter.band(rate), 0.05 * rate));
    const auto each = [&](double value) { return Eigen::VectorXd::Constant(model.dof, value); };
    const cascade loop{rate, each(2.0 * std::numbers::pi * bandwidth), each(1.0), drive_gains(model), {}};
    const reference_maker reference = [filter, loop](const idim::log& recorded) {
        idim::log tracked;
        tracked.t = recorded.t;
        tracked.qr = tracked_reference(recorded, filter, loop);
        return tracked;
    };
    const std::string assumption = fmt::format(
        "{}: the simulated loop follows the measured position with a bandwidth of {:.3g} Hz, {}; noise of the position "
        "below that bandwidth is in the instruments too",
        why, bandwidth, request.bandwidth ? "as asked for" : "assumed");
    return loops_of(model, loop, a_priori, reference, assumption);
}

}  // namespace

void add_loop_options(CLI::App& command, loop_request& request) {
    command.add_flag("--track", request.track,
                     "simulate a loop that follows the measured position, whatever control law is declared");
    command
        .add_option("--bandwidth", request.bandwidth,
                    "bandwidth of such a loop [Hz]; default: what the rows keep, at most a twentieth of the rate")
        ->check(CLI::PositiveNumber);
    command
        .add_option("--bandwidth-scale", request.bandwidth_scale,
                    "natural frequency of the simulated loop as a multiple of the declared one; default 1")
        ->check(CLI::PositiveNumber);
}

simulated_loops simulated_loops_of(const loaded_robot& robot, const std::string& robot_file,
                                   const std::vector<idim::log>& logs, const filter_choice& filter,
                                   const loop_request& request, const Eigen::VectorXd& a_priori) {
    const idim_model_interface& model = robot.model();
    const auto description = generator::read_robot(robot_file);
    const auto without = std::find_if(logs.begin(), logs.end(), [](const idim::log& l) { return l.qr.size() == 0; });
    const bool known = description.control && description.control->law == "pd_cascade";
    if (request.track || !known || without != logs.end()) {
        const std::string why = request.track          ? "declared control law left aside"
                                : !description.control ? "the control law is unknown"
                                : !known ? fmt::format("a control law {} cannot be simulated", description.control->law)
                                         : fmt::format("{} has no reference qr1..", without->file);
        return tracking_loops(model, logs, filter, request, a_priori, why);
    }
    cascade loop = declared_cascade(*description.control, model, a_priori);
    loop.natural_frequency *= request.bandwidth_scale;
    return loops_of(
        model, loop, a_priori, [](const idim::log& recorded) { return recorded; }, "");
}

}  // namespace idim::cli
