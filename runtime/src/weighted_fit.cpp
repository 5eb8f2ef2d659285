#include "weighted_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "sandwich.hpp"

namespace idim {

namespace {

bool all_finite(const observation& rows) {
    return std::all_of(rows.blocks.begin(), rows.blocks.end(), [](const observation_block& block) {
        return std::all_of(block.W.begin(), block.W.end(), [](const Eigen::MatrixXd& W) { return W.allFinite(); }) &&
               std::all_of(block.Y.begin(), block.Y.end(), [](const Eigen::VectorXd& Y) { return Y.allFinite(); });
    });
}

/// Why these rows cannot be solved whatever the weights, or nothing.
std::string obstacle(const observation& rows) {
    if (rows.n_base == 0) {
        return "the model has no parameter to identify";
    }
    if (rows.rows() == 0) {
        return "there are no rows to identify from";
    }
    if (!all_finite(rows)) {
        return "a row holds a value that is not finite";
    }
    return {};
}

/// An estimate that says why there is no chi, its residual that of a model which predicts nothing.
estimate failure(const observation& rows, const rank_report& rank, const std::string& message) {
    estimate result;
    result.rank = rank.rank;
    result.condition_number = rank.condition_number;
    result.scaled_condition_number = rank.scaled_condition_number;
    result.not_excited = rank.not_excited;
    result.samples = rows.rows();
    result.joint_deviation.assign(static_cast<std::size_t>(rows.dof), 0.0);
    result.correlation_length.assign(static_cast<std::size_t>(rows.dof), 1.0);
    if (all_finite(rows)) {
        result.residual = errors(rows, Eigen::VectorXd::Zero(rows.n_base));
    } else {
        result.residual.joints.resize(static_cast<std::size_t>(rows.dof));
    }
    result.message = message;
    return result;
}

void check_places(const observation_block& block, std::size_t joints) {
    if (block.kept.size() != joints) {
        throw std::invalid_argument(
            fmt::format("observation of {} joints has a block that keeps rows of {}", joints, block.kept.size()));
    }
    for (std::size_t j = 0; j < joints; ++j) {
        const std::vector<Eigen::Index>& places = block.kept[j];
        const bool inside = places.empty() || (places.front() >= 0 && places.back() < block.t.size());
        if (!inside || static_cast<Eigen::Index>(places.size()) != block.W[j].rows()) {
            throw std::invalid_argument(fmt::format("joint {}: W has {} rows, {} of {} samples are kept", j + 1,
                                                    block.W[j].rows(), places.size(), block.t.size()));
        }
    }
}

}  // namespace

void check_shapes(const observation& rows) {
    const auto joints = static_cast<std::size_t>(rows.dof);
    for (const observation_block& block : rows.blocks) {
        if (block.W.size() != joints || block.Y.size() != joints) {
            throw std::invalid_argument(fmt::format("observation of {} joints has a block with W of {} and Y of {}",
                                                    joints, block.W.size(), block.Y.size()));
        }
        check_places(block, joints);
        for (std::size_t j = 0; j < joints; ++j) {
            if (block.W[j].cols() != rows.n_base || block.W[j].rows() != block.Y[j].size()) {
                throw std::invalid_argument(
                    fmt::format("joint {}: W is {} x {}, Y has {} rows, the model {} parameters", j + 1,
                                block.W[j].rows(), block.W[j].cols(), block.Y[j].size(), rows.n_base));
            }
        }
    }
}

std::vector<double> joint_deviations(const observation& rows, const joint_series& residual,
                                     const std::vector<double>& parameter_share) {
    std::vector<double> deviation;
    for (int j = 0; j < rows.dof; ++j) {
        double sum = 0.0;
        for (const Eigen::VectorXd& segment : residual[j]) {
            sum += segment.squaredNorm();
        }
        // At least one degree of freedom: rows that determine as many parameters leave a residual of zero anyway.
        const double freedom = std::max(static_cast<double>(rows.rows(j)) - parameter_share[j], 1.0);
        deviation.push_back(std::sqrt(sum / freedom));
    }
    return deviation;
}

joint_series residuals(const observation& rows, const Eigen::VectorXd& chi) {
    joint_series residual(static_cast<std::size_t>(rows.dof));
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < residual.size(); ++j) {
            residual[j].push_back(block.Y[j] - block.W[j] * chi);
        }
    }
    return residual;
}

joint_series scaled(joint_series series, const std::vector<double>& factor) {
    for (std::size_t j = 0; j < series.size(); ++j) {
        for (Eigen::VectorXd& segment : series[j]) {
            segment *= factor[j];
        }
    }
    return series;
}

std::vector<double> weights_of(const std::vector<double>& joint_deviation) {
    const double largest =
        joint_deviation.empty() ? 0.0 : *std::max_element(joint_deviation.begin(), joint_deviation.end());
    std::vector<double> weight;
    for (const double deviation : joint_deviation) {
        weight.push_back(largest > 0.0 ? 1.0 / std::max(deviation, 1e-6 * largest) : 1.0);
    }
    return weight;
}

void add_deviations(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                    const joint_series& score, estimate& result) {
    sandwich robust = robust_covariance(rows, joint_weight, qr, score);
    result.covariance = std::move(robust.covariance);
    result.correlation_length = std::move(robust.correlation_length);
    double sum = 0.0;
    for (const std::vector<Eigen::VectorXd>& segments : score) {
        for (const Eigen::VectorXd& segment : segments) {
            sum += segment.squaredNorm();
        }
    }
    const double freedom = static_cast<double>(rows.rows() - rows.n_base);
    result.std_white = std::sqrt(sum / freedom) * qr.inverse().rowwise().norm();
}

weighted_solution solve_weighted(const observation& rows, const std::vector<double>& joint_weight) {
    check_shapes(rows);
    if (const std::string problem = obstacle(rows); !problem.empty()) {
        return {failure(rows, {}, problem), {}};
    }
    stacked_qr qr = factor(rows, uniform_weights(rows, joint_weight));
    const rank_report rank = examine(qr);
    if (rank.rank < rows.n_base) {
        return {failure(rows, rank,
                        fmt::format("{} rows excite only {} of {} parameters; {} do not move or cannot be told apart",
                                    rows.rows(), rank.rank, rows.n_base, rank.not_excited.size())),
                std::move(qr)};
    }
    if (rows.rows() == rows.n_base) {
        return {
            failure(rows, rank,
                    fmt::format("{} rows for {} parameters leave nothing to judge them by", rows.rows(), rows.n_base)),
            std::move(qr)};
    }
    estimate fit;
    fit.chi = qr.solve();
    fit.converged = true;
    fit.rank = rank.rank;
    fit.condition_number = rank.condition_number;
    fit.scaled_condition_number = rank.scaled_condition_number;
    fit.samples = rows.rows();
    fit.joint_deviation = joint_deviations(rows, residuals(rows, fit.chi), qr.parameter_share());
    fit.residual = errors(rows, fit.chi);
    fit.message = fmt::format("{} parameters from {} rows, all excited", rows.n_base, rows.rows());
    return {std::move(fit), std::move(qr)};
}

estimate weighted_fit(const observation& rows, const std::vector<double>& joint_weight) {
    weighted_solution solution = solve_weighted(rows, joint_weight);
    if (solution.fit.chi.size() > 0) {
        add_deviations(rows, joint_weight, solution.qr, scaled(residuals(rows, solution.fit.chi), joint_weight),
                       solution.fit);
    }
    return std::move(solution.fit);
}

}  // namespace idim
