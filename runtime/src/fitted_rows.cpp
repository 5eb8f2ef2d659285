#include "idim/fitted_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Norms of the regressor's columns [b]: what makes parameters of different units comparable.
Eigen::VectorXd column_norms(const observation& rows) {
    Eigen::VectorXd squares;
    for (const observation_block& block : rows.blocks) {
        for (const Eigen::MatrixXd& W : block.W) {
            const Eigen::VectorXd of_joint = W.colwise().squaredNorm();
            squares = squares.size() == 0 ? of_joint : Eigen::VectorXd(squares + of_joint);
        }
    }
    return squares.cwiseSqrt();
}

/// The part of each step that is taken: Aitken's relaxation of vectors (Irons and Tuck 1969), from the last two steps.
class relaxation {
  public:
    explicit relaxation(double first) : share_(first) {}

    double operator()(const Eigen::VectorXd& step) {
        constexpr double least = 0.1;
        if (last_.size() > 0 && (step - last_).squaredNorm() > 0.0) {
            const Eigen::VectorXd change = step - last_;
            share_ = std::clamp(-share_ * last_.dot(change) / change.squaredNorm(), least, 1.0);
        }
        last_ = step;
        return share_;
    }

  private:
    double share_;
    Eigen::VectorXd last_;
};

/// How far an estimate is from parameters, as change_of_torque; 0 where there is none.
double moved_by(const fitted_rows& fit, const Eigen::VectorXd& from) {
    return fit.result.chi.size() > 0 ? change_of_torque(fit.rows, fit.result.chi - from) : 0.0;
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
    // Weights are an iteration of their own, which leaves some 1e-7 with few rows: less than a hundredth of a
    // deviation.
    constexpr double settled_with_weights = 1e-6;
    fitted_rows fit;
    fit.rows = with_log_columns(model, observe(model, logs, choice));
    fit.result = least_squares(fit.rows, method);
    if (!depends_on_parameters(model)) {
        return fit;
    }
    const std::vector<row_selection> kept = selections(fit.rows);
    std::vector<iteration> steps;
    // The inertia J behind a soft transmission comes out as J^2 / J_0 from rows with J_0: full steps go to and fro,
    // half steps are Newton's for the square root. Other parameters settle at once in full steps.
    const bool soft = has_soft_joint(model);
    relaxation part_of(0.5);
    const Eigen::VectorXd size = column_norms(fit.rows);
    Eigen::VectorXd at = fit.result.chi;
    std::vector<double> weight = weights_for(fit, method);
    bool done = false;
    // Steps without deviations, which cost far more than the solution; they belong to the weights before them, so that
    // the whole estimate is taken once they settle, and again where its weights move it.
    for (int step = 0; step < most_steps && !done && fit.result.chi.size() > 0; ++step) {
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        if (step > 0) {
            const Eigen::VectorXd full = fit.result.chi - at;
            at += (soft ? part_of(full.cwiseProduct(size)) : 1.0) * full;
        }
        fit.rows = with_log_columns(model, observe(model, logs, choice, kept, at.head(model.n_base)));
        fit.result = solve_weighted(fit.rows, weight).fit;
        if (moved_by(fit, at) <= settled) {
            fit.result = least_squares(fit.rows, method);
            weight = weights_for(fit, method);
            done = moved_by(fit, at) <= settled_with_weights;
        }
    }
    if (fit.result.chi.size() > 0) {
        if (!done) {
            fit.result = least_squares(fit.rows, method);
        }
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        fit.result.iterations = steps;
        fit.result.converged = fit.result.converged && done;
        fit.result.message += done ? ""
                                   : fmt::format(
                                         "; the effects of the links' torque did not settle "
                                         "within {} steps",
                                         most_steps);
    }
    return fit;
}

}  // namespace idim
