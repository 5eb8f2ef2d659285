#include "idim/fitted_rows.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

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

/// Steps towards the fixed point of a map that full steps may lead away from: Anderson mixing (Walker and Ni 2011) of
/// the last few steps, each column of which counts by its size.
class mixed_steps {
  public:
    explicit mixed_steps(Eigen::VectorXd size) : size_(std::move(size)) {}

    /// The step to take from `at`, where the map leads `full` further.
    Eigen::VectorXd operator()(const Eigen::VectorXd& at, const Eigen::VectorXd& full) {
        if (last_at_.size() > 0) {
            moves_.push_back(at - last_at_);
            changes_.push_back(full - last_full_);
        }
        if (moves_.size() > depth) {
            moves_.erase(moves_.begin());
            changes_.erase(changes_.begin());
        }
        last_at_ = at;
        last_full_ = full;
        Eigen::VectorXd step = part * full;
        if (!moves_.empty()) {
            const Eigen::MatrixXd moves = side_by_side(moves_);
            const Eigen::MatrixXd changes = side_by_side(changes_);
            const Eigen::MatrixXd sized = size_.asDiagonal() * changes;
            step -= (moves + part * changes) * sized.completeOrthogonalDecomposition().solve(size_.cwiseProduct(full));
        }
        return step;
    }

  private:
    static constexpr std::size_t depth = 8;
    static constexpr double part = 0.5;

    static Eigen::MatrixXd side_by_side(const std::vector<Eigen::VectorXd>& columns) {
        Eigen::MatrixXd all(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
        for (std::size_t c = 0; c < columns.size(); ++c) {
            all.col(static_cast<Eigen::Index>(c)) = columns[c];
        }
        return all;
    }

    Eigen::VectorXd size_;
    std::vector<Eigen::VectorXd> moves_;
    std::vector<Eigen::VectorXd> changes_;
    Eigen::VectorXd last_at_;
    Eigen::VectorXd last_full_;
};

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

/// Weights of the joints as an estimate leaves them.
std::vector<double> weights_for(const fitted_rows& fit, least_squares_method method) {
    return method == least_squares_method::ols ? std::vector<double>(static_cast<std::size_t>(fit.rows.dof), 1.0)
                                               : weights_of(fit.result.joint_deviation);
}

/// Rows and parameters of a model whose regressor depends on its parameters, from these parameters [b] on, or from
/// those of the measured torque where there are none.
fitted_rows settled_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                         const filter_choice& choice, least_squares_method method, const Eigen::VectorXd& start) {
    constexpr int most_steps = 50;
    // Of the torque; the deviations of parameters are many times that. Links are put behind their motors to 1e-11 rad,
    // which is some 1e-8 of the torque of their acceleration.
    const bool soft = has_soft_joint(model);
    const double settled = soft ? 1e-7 : 1e-9;
    fitted_rows fit;
    fit.rows = with_log_columns(model, observe(model, logs, choice, start));
    fit.result = least_squares(fit.rows, method);
    const std::vector<row_selection> kept = selections(fit.rows);
    std::vector<iteration> steps;
    // The inertia J behind a soft transmission comes out as J^2 / J_0 from rows with J_0, where the motion is slower
    // than the link swings: full steps go to and fro, or away. Other parameters settle at once in full steps.
    mixed_steps mixed(column_norms(fit.rows));
    Eigen::VectorXd at = fit.result.chi;
    std::vector<double> weight = weights_for(fit, method);
    bool done = false;
    // Steps without deviations, which cost far more than the solution; they belong to the weights before them, so that
    // the whole estimate is taken once they settle, and again where its weights move it.
    for (int step = 0; step < most_steps && !done && fit.result.chi.size() > 0; ++step) {
        steps.push_back({fit.result.chi, fit.result.residual.relative_error});
        if (step > 0) {
            const Eigen::VectorXd full = fit.result.chi - at;
            at += soft ? mixed(at, full) : full;
        }
        fit.rows = with_log_columns(model, observe(model, logs, choice, kept, at.head(model.n_base)));
        fit.result = solve_weighted(fit.rows, weight).fit;
        if (moved_by(fit, at) <= settled) {
            fit.result = least_squares(fit.rows, method);
            weight = weights_for(fit, method);
            mixed = mixed_steps(column_norms(fit.rows));  // another map from here on
            done = moved_by(fit, at) <= weights_leave(fit);
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

}  // namespace

// Where links swing within the band of the rows, the measured torque says too little of them to begin with: slower rows
// are settled first.
fitted_rows fit_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                     const filter_choice& choice, least_squares_method method) {
    if (!depends_on_parameters(model)) {
        fitted_rows fit;
        fit.rows = with_log_columns(model, observe(model, logs, choice));
        fit.result = least_squares(fit.rows, method);
        return fit;
    }
    fitted_rows fit = settled_rows(model, logs, choice, method, {});
    for (const int times : {2, 4, 8}) {
        if (fit.result.converged || !has_soft_joint(model)) {
            break;
        }
        filter_choice slower = choice;
        slower.decimation *= times;
        const fitted_rows first = settled_rows(model, logs, slower, method, {});
        if (first.result.converged) {
            fit = settled_rows(model, logs, choice, method, first.result.chi.head(model.n_base));
        }
    }
    return fit;
}

}  // namespace idim
