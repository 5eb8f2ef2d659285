#include "idim/fitted_rows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "idim/log_parameters.hpp"
#include "idim/recorded_states.hpp"

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
    double change = 1.0;
    for (int step = 0; step < most_steps && change > settled && fit.result.chi.size() > 0; ++step) {
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        at += step == 0 ? Eigen::VectorXd::Zero(at.size()) : Eigen::VectorXd(share * (fit.result.chi - at));
        fit.rows = with_log_columns(model, observe(model, logs, choice, kept, at.head(model.n_base)));
        fit.result = least_squares(fit.rows, method);
        if (fit.result.chi.size() > 0) {
            change = change_of_torque(fit.rows, fit.result.chi - at);
        }
    }
    if (fit.result.chi.size() > 0) {
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
