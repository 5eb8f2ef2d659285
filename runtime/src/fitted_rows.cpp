#include "idim/fitted_rows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "idim/log_parameters.hpp"
#include "idim/recorded_states.hpp"
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

/// Weights of the joints as an estimate leaves them.
std::vector<double> weights_for(const fitted_rows& fit, least_squares_method method) {
    return method == least_squares_method::ols ? std::vector<double>(static_cast<std::size_t>(fit.rows.dof), 1.0)
                                               : weights_of(fit.result.joint_deviation);
}

}  // namespace

fitted_rows fit_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                     const filter_choice& choice, least_squares_method method) {
    constexpr int most_steps = 50;
    constexpr double settled = 1e-9;  // of the torque; the deviations of parameters are many times that
    fitted_rows fit;
    fit.rows = with_log_columns(model, observe(model, logs, choice));
    fit.result = least_squares(fit.rows, method);
    if (!depends_on_parameters(model)) {
        return fit;
    }
    const std::vector<row_selection> kept = selections(fit.rows);
    std::vector<iteration> steps;
    // The inertia J behind a soft transmission comes out as J^2 / J_0 from rows with J_0: full steps go to and fro,
    // half steps are Newton's for the square root.
    const double share = has_soft_joint(model) ? 0.5 : 1.0;
    Eigen::VectorXd at = fit.result.chi;
    std::vector<double> weight = weights_for(fit, method);
    double change = 1.0;
    // Steps without deviations, which cost far more than the solution; they belong to the weights before them, so that
    // the whole estimate is taken once they settle, and again where its weights move it.
    for (int step = 0; step < most_steps && change > settled && fit.result.chi.size() > 0; ++step) {
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        at += step == 0 ? Eigen::VectorXd::Zero(at.size()) : Eigen::VectorXd(share * (fit.result.chi - at));
        fit.rows = with_log_columns(model, observe(model, logs, choice, kept, at.head(model.n_base)));
        fit.result = solve_weighted(fit.rows, weight).fit;
        change = fit.result.chi.size() > 0 ? change_of_torque(fit.rows, fit.result.chi - at) : 0.0;
        if (change <= settled) {
            fit.result = least_squares(fit.rows, method);
            weight = weights_for(fit, method);
            change = fit.result.chi.size() > 0 ? change_of_torque(fit.rows, fit.result.chi - at) : 0.0;
        }
    }
    if (fit.result.chi.size() > 0) {
        if (change > settled) {
            fit.result = least_squares(fit.rows, method);
        }
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        fit.result.iterations = steps;
        fit.result.converged = fit.result.converged && change <= settled;
        fit.result.message += change <= settled ? ""
                                                : fmt::format(
                                                      "; the effects of the links' torque did not settle "
                                                      "within {} steps",
                                                      most_steps);
    }
    return fit;
}

}  // namespace idim
