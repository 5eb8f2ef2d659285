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

/// Why these rows cannot be solved whatever the weights, or nothing.
std::string obstacle(const joint_triangles& joints) {
    if (joints.columns() == 0) {
        return "the model has no parameter to identify";
    }
    if (joints.rows() == 0) {
        return "there are no rows to identify from";
    }
    if (!joints.finite()) {
        return "a row holds a value that is not finite";
    }
    return {};
}

/// An estimate that says why there is no chi, its residual that of a model which predicts nothing.
estimate failure(const joint_triangles& joints, const rank_report& rank, const std::string& message) {
    estimate result;
    result.rank = rank.rank;
    result.condition_number = rank.condition_number;
    result.scaled_condition_number = rank.scaled_condition_number;
    result.not_excited = rank.not_excited;
    result.samples = joints.rows();
    result.joint_deviation.assign(static_cast<std::size_t>(joints.joints()), 0.0);
    result.correlation_length.assign(static_cast<std::size_t>(joints.joints()), 1.0);
    if (joints.finite()) {
        result.residual = errors(joints, Eigen::VectorXd::Zero(joints.columns()));
    } else {
        result.residual.joints.resize(static_cast<std::size_t>(joints.joints()));
    }
    result.message = message;
    return result;
}

double deviation_of(double residual_square, Eigen::Index rows, double parameter_share) {
    // At least one degree of freedom: rows that determine as many parameters leave a residual of zero anyway.
    return std::sqrt(residual_square / std::max(static_cast<double>(rows) - parameter_share, 1.0));
}

std::vector<double> joint_deviations(const joint_triangles& joints, const Eigen::VectorXd& chi,
                                     const std::vector<double>& parameter_share) {
    std::vector<double> deviation;
    for (int j = 0; j < joints.joints(); ++j) {
        deviation.push_back(
            deviation_of(joints.residual_square(j, chi), joints.rows(j), parameter_share[static_cast<std::size_t>(j)]));
    }
    return deviation;
}

void fill_deviations(sandwich robust, double score_square, Eigen::Index rows, const stacked_qr& qr, estimate& result) {
    result.covariance = std::move(robust.covariance);
    result.correlation_length = std::move(robust.correlation_length);
    const double freedom = static_cast<double>(rows - qr.R.cols());
    result.std_white = std::sqrt(score_square / freedom) * qr.inverse().rowwise().norm();
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
        deviation.push_back(deviation_of(sum, rows.rows(j), parameter_share[static_cast<std::size_t>(j)]));
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
    double sum = 0.0;
    for (const std::vector<Eigen::VectorXd>& segments : score) {
        for (const Eigen::VectorXd& segment : segments) {
            sum += segment.squaredNorm();
        }
    }
    fill_deviations(robust_covariance(rows, joint_weight, qr, score), sum, rows.rows(), qr, result);
}

weighted_solution solve_weighted(const joint_triangles& joints, const std::vector<double>& joint_weight) {
    if (const std::string problem = obstacle(joints); !problem.empty()) {
        return {failure(joints, {}, problem), {}};
    }
    const int b = joints.columns();
    stacked_qr qr = factor(joints, joint_weight);
    const rank_report rank = examine(qr);
    if (rank.rank < b) {
        return {failure(joints, rank,
                        fmt::format("{} rows excite only {} of {} parameters; {} do not move or cannot be told apart",
                                    joints.rows(), rank.rank, b, rank.not_excited.size())),
                std::move(qr)};
    }
    if (joints.rows() == b) {
        return {failure(joints, rank,
                        fmt::format("{} rows for {} parameters leave nothing to judge them by", joints.rows(), b)),
                std::move(qr)};
    }
    estimate fit;
    fit.chi = qr.solve();
    fit.converged = true;
    fit.rank = rank.rank;
    fit.condition_number = rank.condition_number;
    fit.scaled_condition_number = rank.scaled_condition_number;
    fit.samples = joints.rows();
    fit.joint_deviation = joint_deviations(joints, fit.chi, qr.parameter_share());
    fit.residual = errors(joints, fit.chi);
    fit.message = fmt::format("{} parameters from {} rows, all excited", b, joints.rows());
    return {std::move(fit), std::move(qr)};
}

weighted_solution solve_weighted(const observation& rows, const std::vector<double>& joint_weight) {
    check_shapes(rows);
    return solve_weighted(triangles_of(rows), joint_weight);
}

estimate weighted_fit(const row_source& rows, const joint_triangles& joints, const std::vector<double>& joint_weight) {
    weighted_solution solution = solve_weighted(joints, joint_weight);
    estimate& fit = solution.fit;
    if (fit.chi.size() > 0) {
        double square = 0.0;
        for (int j = 0; j < joints.joints(); ++j) {
            const double weight = joint_weight[static_cast<std::size_t>(j)];
            square += weight * weight * joints.residual_square(j, fit.chi);
        }
        const Eigen::MatrixXd inverse = solution.qr.inverse();
        const auto score = rows.residual(fit.chi, joint_weight);
        fill_deviations(robust_covariance(rows, joint_weight, inverse, inverse, *score), square, joints.rows(),
                        solution.qr, fit);
    }
    return std::move(fit);
}

estimate weighted_fit(const observation& rows, const std::vector<double>& joint_weight) {
    check_shapes(rows);
    return weighted_fit(resident_rows(rows), triangles_of(rows), joint_weight);
}

}  // namespace idim
