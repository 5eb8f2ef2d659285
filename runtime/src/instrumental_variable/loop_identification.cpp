#include "idim/loop_identification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "idim/input_error.hpp"
#include "instrumental_variable/instrument_qr.hpp"
#include "instrumental_variable/loop_simulator.hpp"
#include "instrumental_variable/position_output_error.hpp"
#include "sandwich.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// One solution of the instrumental equations.
struct instrument_step {
    Eigen::VectorXd chi;  ///< empty if a rank is lacking
    instrument_qr qr;
    std::vector<double> joint_deviation;
    std::vector<double> joint_weight;
};

/// Every row alike first, then the rows of joint j divided by the deviation of its residual [IV 20].
instrument_step solve(const observation& rows, const observation& instruments) {
    instrument_step step;
    step.joint_weight.assign(static_cast<std::size_t>(rows.dof), 1.0);
    for (int pass = 0; pass < (rows.dof > 1 ? 2 : 1); ++pass) {
        if (pass > 0) {
            step.joint_weight = weights_of(step.joint_deviation);
        }
        step.qr = factor(rows, instruments, step.joint_weight);
        if (!step.qr.full_rank()) {
            step.chi.resize(0);
            return step;
        }
        step.chi = step.qr.solve();
        step.joint_deviation = joint_deviations(rows, residuals(rows, step.chi), step.qr.parameter_share());
    }
    return step;
}

/// An estimate without parameters that says why.
estimate failure(const loop_simulator& simulator, std::vector<iteration> steps, const std::string& what) {
    estimate result;
    const auto joints = static_cast<std::size_t>(simulator.rows().dof);
    result.iterations = std::move(steps);
    result.samples = simulator.rows().rows();
    result.joint_deviation.assign(joints, 0.0);
    result.correlation_length.assign(joints, 1.0);
    result.residual = errors(simulator.rows(), Eigen::VectorXd::Zero(simulator.rows().n_base));
    result.message = what;
    return result;
}

loop_estimate without_parameters(const loop_simulator& simulator, const std::vector<iteration>& steps,
                                 const std::string& what) {
    return {failure(simulator, steps, what), {}};
}

std::string failed_at(std::size_t step, const std::string& what) {
    return fmt::format(
        "iteration {}: {}; try a regular start, a higher bandwidth of the simulated loop, or more exciting motion",
        step, what);
}

std::string names_of(const idim_model_interface& model, const std::vector<int>& columns) {
    std::vector<std::string> names;
    for (const int c : columns) {
        names.emplace_back(model.parameter_names[c]);
    }
    return fmt::format("{}", fmt::join(names, " "));
}

std::string lost_rank(const idim_model_interface& model, const instrument_qr& qr) {
    const bool measured = qr.regressor.rank < model.n_base;
    const rank_report& lacking = measured ? qr.regressor : qr.instruments;
    return fmt::format("the {} lose rank, {} of {}: {} cannot be told apart",
                       measured ? "measured rows" : "instruments", lacking.rank, model.n_base,
                       names_of(model, lacking.not_excited));
}

/// The joint whose simulated motion is farthest from the measured one.
std::size_t farthest_joint(const iteration& step) {
    const auto farther = [](const motion_distance& a, const motion_distance& b) { return a.q < b.q; };
    return static_cast<std::size_t>(std::max_element(step.to_measured.begin(), step.to_measured.end(), farther) -
                                    step.to_measured.begin());
}

std::string how_far(const loop_simulator& simulator, const iteration& step) {
    const std::size_t joint = farthest_joint(step);
    return fmt::format("; the simulated motion of joint {} is farthest from the measured one, {:.2g} %",
                       simulator.model().joint_names[joint], 100.0 * step.to_measured[joint].q);
}

/// |W_s (chi - before)| / |Y - W_s chi|: how far the last step moved what is predicted, in units of what is not.
double last_move(const observation& along, const iteration& now, const iteration& before) {
    observation moved = along;
    double torque = 0.0;
    for (observation_block& block : moved.blocks) {
        for (std::size_t j = 0; j < block.Y.size(); ++j) {
            torque += block.Y[j].squaredNorm();
            block.Y[j].setZero();
        }
    }
    double square = 0.0;
    const Eigen::VectorXd change = now.chi - before.chi;
    for (const observation_block& block : moved.blocks) {
        for (const Eigen::MatrixXd& W : block.W) {
            square += (W * change).squaredNorm();
        }
    }
    const double left = now.simulated_error * std::sqrt(torque);
    return left > 0.0 ? std::sqrt(square) / left : (square > 0.0 ? 1.0 : 0.0);
}

/// [IV 27], and the prediction has settled too: |Y - W_s chi| alone may pass a point where it does not change.
bool has_settled(const observation& along, const std::vector<iteration>& steps, double tolerance) {
    if (steps.size() < 2) {
        return false;
    }
    const iteration& now = steps.back();
    const iteration& before = steps[steps.size() - 2];
    const double change = std::abs(now.simulated_error - before.simulated_error);
    return change <= tolerance * before.simulated_error && last_move(along, now, before) <= tolerance;
}

void add_deviations(const observation& rows, const observation& instruments, const instrument_step& step,
                    const Eigen::VectorXd& chi, estimate& result) {
    const Eigen::MatrixXd to_parameters = step.qr.to_parameters();
    const joint_series score = scaled(residuals(rows, chi), step.joint_weight);
    sandwich robust =
        robust_covariance(instruments, step.joint_weight, step.qr.instrument_inverse(), to_parameters, score);
    result.covariance = std::move(robust.covariance);
    result.correlation_length = std::move(robust.correlation_length);
    double sum = 0.0;
    for (const std::vector<Eigen::VectorXd>& segments : score) {
        for (const Eigen::VectorXd& segment : segments) {
            sum += segment.squaredNorm();
        }
    }
    result.std_white = std::sqrt(sum / static_cast<double>(rows.rows() - rows.n_base)) * to_parameters.rowwise().norm();
}

/// What is known once the iterations have settled on chi with the instruments of chi itself.
estimate settled(const loop_simulator& simulator, const observation& regressor, const observation& instruments,
                 std::vector<iteration> steps, loop_method method, const loop_options& options) {
    const Eigen::VectorXd chi = steps.back().chi;
    const instrument_step last = solve(regressor, instruments);
    if (last.chi.size() == 0) {
        return failure(simulator, steps, failed_at(steps.size() - 1, lost_rank(simulator.model(), last.qr)));
    }
    if (last.qr.first_stage(regressor.rows()) < options.weakest_instruments) {
        const std::string weak = fmt::format("the instruments hardly tell of {}",
                                             simulator.model().parameter_names[last.qr.least_explained]);
        return failure(simulator, steps, failed_at(steps.size() - 1, weak + how_far(simulator, steps.back())));
    }
    estimate result;
    result.chi = chi;
    result.converged = true;
    result.rank = last.qr.instruments.rank;
    result.condition_number = last.qr.regressor.condition_number;
    result.scaled_condition_number = last.qr.regressor.scaled_condition_number;
    result.samples = regressor.rows();
    result.joint_deviation = last.joint_deviation;
    result.iterations = std::move(steps);
    result.residual = errors(simulator.rows(), chi);
    add_deviations(regressor, instruments, last, chi, result);
    result.message =
        fmt::format("{} parameters from {} rows in {} steps", chi.size(), result.samples, result.iterations.size() - 1);
    if (method == loop_method::iv) {
        result.message += fmt::format("; the spans of instruments and regressor are at most {:.1f} degrees apart",
                                      std::acos(std::min(last.qr.smallest_cosine, 1.0)) * 180.0 / M_PI);
    }
    return result;
}

/// Whether the step to `next` leads back to where the last but one came from, and no nearer: at a slow reversal the
/// simulated sign of a velocity can flip with chi, and then no point is its own solution. Half a step settles between.
bool alternates(const std::vector<iteration>& steps, const Eigen::VectorXd& next) {
    if (steps.size() < 3) {
        return false;
    }
    const Eigen::VectorXd& now = steps.back().chi;
    const Eigen::VectorXd last = (now - steps[steps.size() - 2].chi).cwiseQuotient(now.cwiseAbs().cwiseMax(1e-12));
    const Eigen::VectorXd ahead = (next - now).cwiseQuotient(now.cwiseAbs().cwiseMax(1e-12));
    return ahead.dot(last) < -0.5 * last.squaredNorm();
}

/// iv and didim: the measured regressor, or that of the simulated motion, against instruments of the latter.
loop_estimate fit_torques(const loop_simulator& simulator, loop_method method, Eigen::VectorXd chi,
                          const loop_options& options) {
    std::vector<iteration> steps;
    double part = 1.0;  // of the way to the solution
    for (std::size_t k = 0;; ++k) {
        const simulated_motions motions = simulator.simulate({chi}).front();
        if (!motions.failure.empty()) {
            steps.push_back({chi, errors(simulator.rows(), chi).relative_error});
            return without_parameters(simulator, steps, failed_at(k, motions.failure));
        }
        const observation along = simulator.regressor_along(motions.logs);
        const observation& regressor = method == loop_method::iv ? simulator.rows() : along;
        steps.push_back(simulator.judge(chi, motions.logs, along));
        if (has_settled(along, steps, options.tolerance)) {
            estimate fit = settled(simulator, regressor, along, steps, method, options);
            return {fit, fit.chi.size() > 0 ? along : observation()};
        }
        if (static_cast<int>(k) == options.most_iterations) {
            const std::string what = "the parameters still change" + how_far(simulator, steps.back());
            return without_parameters(simulator, steps, failed_at(k, what));
        }
        const instrument_step step = solve(
            options.corrects_processing ? simulator.corrected(regressor, motions.logs, along, chi) : regressor, along);
        if (step.chi.size() == 0) {
            loop_estimate lost =
                without_parameters(simulator, steps, failed_at(k, lost_rank(simulator.model(), step.qr)));
            lost.fit.rank = std::min(step.qr.regressor.rank, step.qr.instruments.rank);
            return lost;
        }
        part *= alternates(steps, step.chi) ? 0.5 : 1.0;
        chi += part * (step.chi - chi);
    }
}

void check_start(const loop_experiment& experiment, const observation& rows, const Eigen::VectorXd& start) {
    check_shapes(rows);
    if (start.size() != experiment.model.n_base || rows.n_base != experiment.model.n_base ||
        rows.blocks.size() != experiment.logs.size()) {
        throw std::invalid_argument("identify_in_loop: start, rows and logs do not belong to one model and experiment");
    }
}

}  // namespace

loop_estimate identify_in_loop(const loop_experiment& experiment, const closed_loop& loop, const observation& rows,
                               loop_method method, const Eigen::VectorXd& start, const loop_options& options) {
    check_start(experiment, rows, start);
    const loop_simulator simulator(experiment, loop, rows);
    if (rows.rows() <= rows.n_base) {
        return without_parameters(
            simulator, {},
            fmt::format("{} rows are left without rests and the transient of the simulated loop, for {} "
                        "parameters; record longer, or simulate a higher bandwidth",
                        rows.rows(), rows.n_base));
    }
    if (method == loop_method::cloe) {
        estimate fit = fit_positions(simulator, start, options);
        if (fit.chi.size() == 0) {
            return {fit, {}};
        }
        return {fit, simulator.regressor_along(simulator.simulate({fit.chi}).front().logs)};
    }
    return fit_torques(simulator, method, start, options);
}

loop_validation validate_in_loop(const loop_experiment& experiment, const closed_loop& loop, const observation& rows,
                                 const Eigen::VectorXd& chi) {
    check_start(experiment, rows, chi);
    const loop_simulator simulator(experiment, loop, rows);
    const simulated_motions motions = simulator.simulate({chi}).front();
    if (!motions.failure.empty()) {
        return {{}, {}, motions.failure};
    }
    const observation along = simulator.regressor_along(motions.logs);
    return {simulator.judge(chi, motions.logs, along), errors(along, chi), {}};
}

}  // namespace idim
