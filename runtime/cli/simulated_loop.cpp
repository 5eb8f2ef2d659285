#include "simulated_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "declared_law.hpp"
#include "description/robot_description.hpp"
#include "idim/control_law.hpp"
#include "idim/input_error.hpp"
#include "idim/pd_cascade.hpp"
#include "idim/simulation.hpp"
#include "idim/zero_phase_filter.hpp"

namespace idim::cli {

namespace {

/// A cascade PD by its natural frequency and damping, the gains for any inertia [IV 44-46].
struct cascade {
    double rate = 0.0;
    Eigen::VectorXd natural_frequency, damping, drive_gain;

    pd_cascade law(const Eigen::VectorXd& inertia) const {
        return tune_pd_cascade(rate, natural_frequency, damping, inertia, drive_gain);
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

idim::log follow(const idim_model_interface& model, const Eigen::VectorXd& chi, const control_law& law,
                 const idim::log& reference) {
    simulated_loop_setup setup{model, chi, law, reference};
    setup.start_velocity = reference_velocity(reference, 1.0 / law.rate);
    // Estimates on their way part rotor and link so badly that one of them may have no inertia left.
    setup.integration.rigid_transmissions = true;
    const simulated_motion simulated = simulate(setup);
    if (simulated.failure) {
        throw data_error(simulated.failure->message);
    }
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

/// wn of a declared law: as it is given, or from gains kp and kv with the inertia J [IV 43]; else a tenth of the
/// rate's.
Eigen::VectorXd natural_frequency_of(const law_declaration& declared, const Eigen::VectorXd& drive_gain,
                                     const Eigen::VectorXd& inertia) {
    const auto given = [&](const std::string& name) -> Eigen::VectorXd {
        const auto found = declared.values.find(name);
        if (found == declared.values.end()) {
            return {};
        }
        const std::vector<double>& values = found->second;
        return values.size() == 1 ? Eigen::VectorXd::Constant(inertia.size(), values.front())
                                  : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), inertia.size()));
    };
    if (const Eigen::VectorXd wn = given("wn"); wn.size() > 0) {
        return wn;
    }
    const Eigen::VectorXd kp = given("kp");
    const Eigen::VectorXd kv = given("kv");
    if (kp.size() > 0 && kv.size() > 0) {
        return (kp.array() * kv.array() * drive_gain.array() / inertia.array()).sqrt();
    }
    // Position control alone: its bandwidth is kp.
    return kp.size() > 0 ? kp : Eigen::VectorXd::Constant(inertia.size(), 0.1 * declared.rate);
}

/// The declared law, wn multiplied by `scale`, simulated along the recorded references.
simulated_loops declared_loops(const idim_model_interface& model, law_declaration declared, double scale,
                               const Eigen::VectorXd& a_priori) {
    for (double& wn : declared.values["wn"]) {
        wn *= scale;
    }
    if (declared.values["wn"].empty()) {
        declared.values.erase("wn");
    }
    const std::shared_ptr<const control_law> own = make_control_law(declared, model, a_priori);
    const Eigen::VectorXd wn = natural_frequency_of(declared, own->drive_gain, largest_inertia(model, a_priori));
    simulated_loops loops;
    loops.rescaled = {[&model, own](const Eigen::VectorXd& chi, const idim::log& recorded) {
                          const std::unique_ptr<control_law> law = own->clone();
                          law->tune(largest_inertia(model, chi));
                          return follow(model, chi, *law, recorded);
                      },
                      wn, ""};
    loops.fixed = {[&model, own](const Eigen::VectorXd& chi, const idim::log& recorded) {
                       return follow(model, chi, *own, recorded);
                   },
                   wn, ""};
    return loops;
}

simulated_loops tracking_loops(const idim_model_interface& model, const std::vector<idim::log>& logs,
                               const filter_choice& filter, const loop_request& request,
                               const Eigen::VectorXd& a_priori, const std::string& why) {
    const double rate = static_cast<double>(logs.front().samples() - 1) / logs.front().duration();
    const double bandwidth = request.bandwidth.value_or(std::min(filter.band(rate), 0.05 * rate));
    const auto each = [&](double value) { return Eigen::VectorXd::Constant(model.dof, value); };
    const cascade loop{rate, each(2.0 * std::numbers::pi * bandwidth), each(1.0), drive_gains(model)};
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
    if (request.track || !description.control || without != logs.end()) {
        const std::string why = request.track          ? "declared control law left aside"
                                : !description.control ? "the control law is unknown"
                                                       : fmt::format("{} has no reference qr1..", without->file);
        return tracking_loops(model, logs, filter, request, a_priori, why);
    }
    const generator::control_description& control = *description.control;
    if (request.bandwidth_scale != 1.0 && control.values.count("wn") == 0) {
        throw input_error({"", 0, "--bandwidth-scale"}, "needs a control law that declares wn");
    }
    return declared_loops(model, law_declaration_of(control), request.bandwidth_scale, a_priori);
}

}  // namespace idim::cli
