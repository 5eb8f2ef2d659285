#include "idim/fitted_rows.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "idim/log_parameters.hpp"
#include "idim/recorded_states.hpp"
#include "stacked_qr.hpp"
#include "swing_sensitivity.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

std::vector<row_selection> selections(const observation& rows) {
    std::vector<row_selection> kept;
    for (const observation_block& block : rows.blocks) {
        kept.push_back(block.kept);
    }
    return kept;
}

/// Change of the parameters as a share of the torque that it makes.
double change_of_torque(const observation& rows, const Eigen::VectorXd& change) {
    double moved = 0.0;
    double all = 0.0;
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            moved += (block.W[j] * change).squaredNorm();
            all += block.Y[j].squaredNorm();
        }
    }
    return all > 0.0 ? std::sqrt(moved / all) : 0.0;
}

/// How far an estimate is from parameters, as change_of_torque; 0 where there is none.
double moved_by(const fitted_rows& fit, const Eigen::VectorXd& from) {
    return fit.result.chi.size() > 0 ? change_of_torque(fit.rows, fit.result.chi - from) : 0.0;
}

/// What the weights, an iteration of their own, may leave open, as change_of_torque: a twentieth of the change that one
/// deviation of every parameter makes, and no less than the 1e-6 of few rows.
double weights_leave(const fitted_rows& fit) {
    const double deviation = fit.result.residual.relative_error * std::sqrt(static_cast<double>(fit.result.chi.size()) /
                                                                            static_cast<double>(fit.rows.rows()));
    return std::max(1e-6, 0.05 * deviation);
}

/// Weights of the joints as an estimate leaves them; 1 where there is none.
std::vector<double> weights_for(const fitted_rows& fit, least_squares_method method) {
    return method == least_squares_method::ols || fit.result.chi.size() == 0
               ? std::vector<double>(static_cast<std::size_t>(fit.rows.dof), 1.0)
               : weights_of(fit.result.joint_deviation);
}

/// |Y - W chi|^2, joints weighted.
double loss(const observation& rows, const std::vector<double>& weight, const Eigen::VectorXd& chi) {
    double sum = 0.0;
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            sum += weight[j] * weight[j] * (block.Y[j] - block.W[j] * chi).squaredNorm();
        }
    }
    return sum;
}

/// The parameters of the least norm, columns scaled, that fit rows best: where rotors move as their links do, half of
/// their inertia for each.
Eigen::VectorXd shared_parameters(const observation& rows, const std::vector<double>& weight) {
    const stacked_qr qr = factor(triangles_of(rows), weight);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-8);
    return solver.compute(qr.R).solve(qr.z).cwiseQuotient(qr.column_norm);
}

/// Rows of one model and its logs, whose regressor depends on the parameters.
class dependent_rows {
  public:
    dependent_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                   const filter_choice& choice, std::vector<row_selection> kept)
        : model_(model), logs_(logs), choice_(choice), kept_(std::move(kept)) {}

    observation at(const Eigen::VectorXd& chi) const {
        return with_log_columns(model_, observe(model_, logs_, choice_, kept_, chi.head(model_.n_base)));
    }
    observation linearised_at(const Eigen::VectorXd& chi, observation rows) const {
        return has_soft_joint(model_) ? linearised(model_, logs_, choice_, std::move(rows), chi) : rows;
    }
    /// Links are rigid without inertia.
    observation rigid() const { return at(Eigen::VectorXd::Zero(model_.n_base)); }

  private:
    const idim_model_interface& model_;
    const std::vector<filtered_samples>& logs_;
    filter_choice choice_;
    std::vector<row_selection> kept_;
};

/// Where the steps of Gauss and Newton begin: with the better of the parameters that rows of the measured torque give
/// and of those that rigid transmissions give.
Eigen::VectorXd first_parameters(const dependent_rows& rows, const fitted_rows& fit,
                                 const std::vector<double>& weight) {
    const Eigen::VectorXd shared = shared_parameters(rows.rigid(), weight);
    const bool followed = fit.result.chi.size() > 0 &&
                          loss(rows.at(fit.result.chi), weight, fit.result.chi) < loss(rows.at(shared), weight, shared);
    return followed ? fit.result.chi : shared;
}

constexpr int most_fit_steps = 50;

/// Repeats rows and estimate from `at` on until the parameters stay; returns whether they do, and notes the steps.
bool settle(const dependent_rows& rows, bool soft, least_squares_method method, Eigen::VectorXd at, fitted_rows& fit,
            std::vector<iteration>& steps) {
    // What a twist changes beside inertias is left out of the derivative: near its minimum the loss may rise a little.
    constexpr double may_rise = 1.02;
    // Of the torque; the deviations of parameters are many times that. Links are put behind their motors to 1e-11 rad,
    // which is some 1e-8 of the torque of their acceleration.
    const double settled = soft ? 1e-7 : 1e-9;
    std::vector<double> weight = weights_for(fit, method);
    Eigen::VectorXd good = at;
    double least = std::numeric_limits<double>::infinity();
    // Steps without deviations, which cost far more than the solution; they belong to the weights before them, so that
    // the whole estimate is taken once they settle, and again where its weights move it.
    for (int step = 0; step < most_fit_steps; ++step) {
        const observation here = rows.at(at);
        const double lost = loss(here, weight, at);
        fit.rows = rows.linearised_at(at, here);
        fit.result = solve_weighted(fit.rows, weight).fit;
        if (fit.result.chi.size() == 0 || (soft && lost > may_rise * least)) {
            if (step == 0) {
                return false;
            }
            at = good + 0.25 * (at - good);  // too far
            continue;
        }
        steps.push_back({at, fit.result.residual.relative_error});
        good = at;
        least = lost;
        if (moved_by(fit, at) <= settled) {
            fit.result = least_squares(fit.rows, method);
            weight = weights_for(fit, method);
            least = std::numeric_limits<double>::infinity();
            if (moved_by(fit, at) <= weights_leave(fit)) {
                return true;
            }
        }
        at = fit.result.chi;
    }
    fit.rows = rows.linearised_at(good, rows.at(good));  // the last step may have been one too far
    fit.result = least_squares(fit.rows, method);
    return false;
}

}  // namespace

fitted_rows fit_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                     const filter_choice& choice, least_squares_method method) {
    const bool soft = has_soft_joint(model);
    fitted_rows fit;
    fit.rows = with_log_columns(model, observe(model, logs, choice));
    fit.result = least_squares(fit.rows, method);
    if (!depends_on_parameters(model) || (fit.result.chi.size() == 0 && !soft)) {
        return fit;
    }
    const dependent_rows rows(model, logs, choice, selections(fit.rows));
    const Eigen::VectorXd first = soft ? first_parameters(rows, fit, weights_for(fit, method)) : fit.result.chi;
    std::vector<iteration> steps;
    const bool done = settle(rows, soft, method, first, fit, steps);
    if (fit.result.chi.size() > 0) {
        if (soft) {
            fit.result.residual = errors(rows.at(fit.result.chi), fit.result.chi);
        }
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        fit.result.iterations = steps;
        fit.result.converged = fit.result.converged && done;
        fit.result.message += done ? ""
                                   : fmt::format(
                                         "; the effects of the links' torque did not settle "
                                         "within {} steps",
                                         most_fit_steps);
    }
    return fit;
}

}  // namespace idim
