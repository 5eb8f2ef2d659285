#include "instrumental_variable/position_output_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "idim/zero_phase_filter.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// A perturbed parameter changes the torque of its joints by this part.
constexpr double perturbation = 1e-3;
constexpr int most_halvings = 8;

using position_blocks = std::vector<std::vector<Eigen::VectorXd>>;  ///< [block][joint]

/// Filtered, decimated positions on the rows.
position_blocks positions_of(const loop_simulator& simulator, const std::vector<filtered_samples>& logs) {
    position_blocks result;
    for (std::size_t i = 0; i < logs.size(); ++i) {
        const Eigen::MatrixXd q = decimate(logs[i].q, simulator.experiment().filter.decimation);
        const row_selection& kept = simulator.rows().blocks[i].kept;
        std::vector<Eigen::VectorXd> joints;
        for (std::size_t j = 0; j < kept.size(); ++j) {
            joints.emplace_back(q(kept[j], static_cast<Eigen::Index>(j)));
        }
        result.push_back(std::move(joints));
    }
    return result;
}

/// Steps of the differences [b]: a column of W times its step is `perturbation` of the torque of the joints it acts on.
Eigen::VectorXd difference_steps(const observation& rows) {
    Eigen::VectorXd share = Eigen::VectorXd::Zero(rows.n_base);
    for (int j = 0; j < rows.dof; ++j) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(rows.n_base);
        double torque = 0.0;
        for (const observation_block& block : rows.blocks) {
            column += block.W[j].colwise().squaredNorm().transpose();
            torque += block.Y[j].squaredNorm();
        }
        if (torque > 0.0) {
            share += column / torque;
        }
    }
    return (share.array() > 0.0).select(perturbation / share.array().sqrt(), perturbation);
}

/// Present point of the search.
struct search_point {
    Eigen::VectorXd chi;
    std::vector<filtered_samples> motions;
    position_blocks q;
};

/// Rows of the linearised problem: J chi = q_measured - q_simulated + J chi_k, J the sensitivities.
class linearised_positions {
  public:
    linearised_positions(const loop_simulator& simulator, const position_blocks& measured)
        : simulator_(simulator), measured_(measured), steps_(difference_steps(simulator.rows())) {}

    /// Empty, with the reason in `failure`, if a parameter can be moved neither up nor down.
    observation rows_at(const search_point& point, std::string& failure) const {
        std::vector<Eigen::VectorXd> moved;
        for (Eigen::Index c = 0; c < steps_.size(); ++c) {
            moved.push_back(point.chi);
            moved.back()[c] += steps_[c];
        }
        std::vector<simulated_motions> motions = simulator_.simulate(moved);
        observation rows = simulator_.rows();
        for (std::size_t c = 0; c < motions.size(); ++c) {
            double step = steps_[static_cast<Eigen::Index>(c)];
            if (!motions[c].failure.empty()) {
                step = -step;
                moved[c] = point.chi;
                moved[c][static_cast<Eigen::Index>(c)] += step;
                motions[c] = simulator_.simulate({moved[c]}).front();
            }
            if (!motions[c].failure.empty()) {
                failure = motions[c].failure;
                return {};
            }
            fill_column(rows, static_cast<Eigen::Index>(c), positions_of(simulator_, motions[c].logs), point.q, step);
        }
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            for (std::size_t j = 0; j < rows.blocks[i].Y.size(); ++j) {
                rows.blocks[i].Y[j] = measured_[i][j] - point.q[i][j] + rows.blocks[i].W[j] * point.chi;
            }
        }
        return rows;
    }

  private:
    static void fill_column(observation& rows, Eigen::Index column, const position_blocks& moved,
                            const position_blocks& from, double step) {
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            for (std::size_t j = 0; j < rows.blocks[i].W.size(); ++j) {
                rows.blocks[i].W[j].col(column) = (moved[i][j] - from[i][j]) / step;
            }
        }
    }

    const loop_simulator& simulator_;
    const position_blocks& measured_;
    Eigen::VectorXd steps_;
};

/// sum_j w_j^2 |q_j - q_sj|^2.
double misfit(const position_blocks& measured, const position_blocks& simulated, const std::vector<double>& weight) {
    double sum = 0.0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        for (std::size_t j = 0; j < weight.size(); ++j) {
            sum += weight[j] * weight[j] * (measured[i][j] - simulated[i][j]).squaredNorm();
        }
    }
    return sum;
}

class position_search {
  public:
    position_search(const loop_simulator& simulator, const loop_options& options)
        : simulator_(simulator),
          options_(options),
          measured_(positions_of(simulator, simulator.measured())),
          linear_(simulator, measured_) {}

    estimate run(const Eigen::VectorXd& start) {
        search_point point;
        if (!move_to(start, point)) {
            return failed();
        }
        note(point);
        for (int k = 0; k < options_.most_iterations; ++k) {
            const observation rows = linear_.rows_at(point, failure_);
            if (rows.blocks.empty()) {
                return failed();
            }
            estimate fit = least_squares(rows, least_squares_method::wls);
            if (fit.chi.size() == 0) {
                failure_ = "the simulated positions do not depend on every parameter: " + fit.message;
                estimate lost = failed();
                lost.not_excited = fit.not_excited;
                lost.rank = fit.rank;
                return lost;
            }
            const bool moved = improve(fit, point);
            if (!moved || gain_ <= options_.tolerance) {
                return finished(std::move(fit), point);
            }
        }
        failure_ = "the parameters still change";
        return failed();
    }

  private:
    bool move_to(const Eigen::VectorXd& chi, search_point& point) {
        simulated_motions motions = simulator_.simulate({chi}).front();
        if (!motions.failure.empty()) {
            failure_ = motions.failure;
            return false;
        }
        position_blocks q = positions_of(simulator_, motions.logs);
        point = {chi, std::move(motions.logs), std::move(q)};
        return true;
    }

    /// Follows the step of `fit` as far as it lowers the misfit; false if it does not at all.
    bool improve(const estimate& fit, search_point& point) {
        const std::vector<double> weight = weights_of(fit.joint_deviation);
        const double before = misfit(measured_, point.q, weight);
        const Eigen::VectorXd step = fit.chi - point.chi;
        double part = 1.0;
        for (int halving = 0; halving < most_halvings; ++halving, part *= 0.5) {
            search_point next;
            if (!move_to(point.chi + part * step, next)) {
                continue;
            }
            const double after = misfit(measured_, next.q, weight);
            if (after < before) {
                gain_ = 1.0 - std::sqrt(after / before);
                point = std::move(next);
                note(point);
                return true;
            }
        }
        return false;
    }

    void note(const search_point& point) {
        steps_.push_back(simulator_.judge(point.chi, point.motions, simulator_.regressor_along(point.motions)));
    }

    estimate finished(estimate fit, const search_point& point) {
        fit.chi = point.chi;
        fit.converged = true;
        fit.residual = errors(simulator_.rows(), point.chi);
        fit.message = fmt::format("{} parameters from the positions of {} rows in {} steps", point.chi.size(),
                                  fit.samples, steps_.size() - 1);
        fit.iterations = std::move(steps_);
        return fit;
    }

    estimate failed() {
        const auto joints = static_cast<std::size_t>(simulator_.rows().dof);
        estimate result;
        result.message =
            fmt::format("iteration {}: {}; try values nearer to the robot's to start from, or more exciting motion",
                        steps_.empty() ? 0 : steps_.size() - 1, failure_);
        result.iterations = std::move(steps_);
        result.samples = simulator_.rows().rows();
        result.joint_deviation.assign(joints, 0.0);
        result.correlation_length.assign(joints, 1.0);
        result.residual = errors(simulator_.rows(), Eigen::VectorXd::Zero(simulator_.rows().n_base));
        return result;
    }

    const loop_simulator& simulator_;
    const loop_options& options_;
    position_blocks measured_;
    linearised_positions linear_;
    std::vector<iteration> steps_;
    std::string failure_;
    double gain_ = std::numeric_limits<double>::infinity();
};

}  // namespace

estimate fit_positions(const loop_simulator& simulator, const Eigen::VectorXd& start, const loop_options& options) {
    return position_search(simulator, options).run(start);
}

}  // namespace idim
