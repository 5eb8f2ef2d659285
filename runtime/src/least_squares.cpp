#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "idim/estimate.hpp"
#include "stacked_qr.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

// Huber 1964: linear beyond 1.345 deviations, which keeps 95 % of the efficiency under normal noise.
constexpr double huber_bend = 1.345;
// Median absolute value of a normal variable is 1 / 1.4826 of its deviation.
constexpr double normal_consistency = 1.4826;
constexpr int most_iterations = 100;
// From here on the scales are held: what is left is convex in chi, so that it cannot cycle with the median.
constexpr int scale_iterations = 10;
constexpr double smallest_change = 1e-10;

/// Per joint: 1.4826 times the median of |residual|, with the correction for the parameters that the joint's rows
/// determine.
std::vector<double> robust_scales(const observation& rows, const joint_series& residual,
                                  const std::vector<double>& parameter_share) {
    std::vector<double> scale;
    for (int j = 0; j < rows.dof; ++j) {
        std::vector<double> size;
        for (const Eigen::VectorXd& segment : residual[j]) {
            for (const double e : segment) {
                size.push_back(std::abs(e));
            }
        }
        if (size.empty()) {
            scale.push_back(0.0);
            continue;
        }
        const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
        std::nth_element(size.begin(), middle, size.end());
        const double samples = static_cast<double>(size.size());
        const double freedom = std::max(samples - parameter_share[j], 1.0);
        scale.push_back(normal_consistency * *middle * std::sqrt(samples / freedom));
    }
    return scale;
}

/// Row weights sqrt(min(1, bend / |u|)) times the joint's weight, u the residual in deviations of its joint.
joint_series huber_weights(const joint_series& residual, const std::vector<double>& joint_weight) {
    joint_series weights = scaled(residual, joint_weight);
    for (std::size_t j = 0; j < weights.size(); ++j) {
        for (Eigen::VectorXd& segment : weights[j]) {
            segment = joint_weight[j] * (huber_bend / segment.array().abs().max(huber_bend)).sqrt();
        }
    }
    return weights;
}

/// Deviations of an M-estimate [Huber 1981, section 7.6]: bread sum_j mean(psi') X'X / s_j^2, score psi(e / s_j), here
/// both divided so that the bread is W'W of rows weighted joint by joint.
void add_robust_deviations(const observation& rows, const joint_series& residual,
                           const std::vector<double>& joint_weight, estimate& result) {
    joint_series score = scaled(residual, joint_weight);
    std::vector<double> bread_weight;
    for (std::size_t j = 0; j < score.size(); ++j) {
        Eigen::Index inside = 0;
        Eigen::Index all = 0;
        for (Eigen::VectorXd& segment : score[j]) {
            inside += (segment.array().abs() <= huber_bend).count();
            all += segment.size();
            segment = segment.cwiseMax(-huber_bend).cwiseMin(huber_bend);
        }
        // At least half of the rows lie inside by the choice of the scale; 1 for a joint without rows.
        const double slope = all > 0 ? std::sqrt(static_cast<double>(inside) / static_cast<double>(all)) : 1.0;
        bread_weight.push_back(slope * joint_weight[j]);
        for (Eigen::VectorXd& segment : score[j]) {
            segment /= slope;
        }
    }
    add_deviations(rows, bread_weight, factor(triangles_of(rows), bread_weight), score, result);
}

/// Iteratively reweighted least squares from `start`, Huber's loss, scale per joint by the median.
estimate reweighted(const observation& rows, weighted_solution start) {
    estimate result = std::move(start.fit);
    stacked_qr qr = std::move(start.qr);
    result.converged = false;
    result.iterations = {{result.chi, result.residual.relative_error}};
    std::vector<double> scale;
    for (int step = 0; step < most_iterations && !result.converged; ++step) {
        const joint_series residual = residuals(rows, result.chi);
        if (step < scale_iterations) {
            scale = robust_scales(rows, residual, qr.parameter_share());
        }
        qr = factor(rows, huber_weights(residual, weights_of(scale)));
        const Eigen::VectorXd chi = qr.solve();
        const Eigen::VectorXd change = (chi - result.chi).cwiseProduct(qr.column_norm);
        result.converged = (qr.R * change).norm() <= smallest_change * qr.z.norm();
        result.chi = chi;
        result.iterations.push_back({chi, errors(rows, chi).relative_error});
    }
    const rank_report rank = examine(qr);
    result.condition_number = rank.condition_number;
    result.scaled_condition_number = rank.scaled_condition_number;
    result.joint_deviation = scale;
    result.residual = errors(rows, result.chi);
    add_robust_deviations(rows, residuals(rows, result.chi), weights_of(scale), result);
    const std::size_t steps = result.iterations.size() - 1;
    result.message = result.converged ? fmt::format("{}; row weights settled in {} steps", result.message, steps)
                                      : fmt::format("row weights still changed after {} steps", steps);
    return result;
}

}  // namespace

estimate least_squares(const row_source& rows, const joint_triangles& joints, least_squares_method method) {
    const std::vector<double> unweighted(static_cast<std::size_t>(joints.joints()), 1.0);
    if (method == least_squares_method::ols) {
        return weighted_fit(rows, joints, unweighted);
    }
    estimate ordinary = solve_weighted(joints, unweighted).fit;
    return ordinary.chi.size() == 0 ? ordinary : weighted_fit(rows, joints, weights_of(ordinary.joint_deviation));
}

estimate least_squares(const observation& rows, least_squares_method method) {
    check_shapes(rows);
    const joint_triangles joints = triangles_of(rows);
    if (method != least_squares_method::irls) {
        return least_squares(resident_rows(rows), joints, method);
    }
    estimate ordinary = solve_weighted(joints, std::vector<double>(static_cast<std::size_t>(rows.dof), 1.0)).fit;
    if (ordinary.chi.size() == 0) {
        return ordinary;
    }
    weighted_solution start = solve_weighted(joints, weights_of(ordinary.joint_deviation));
    return start.fit.chi.size() > 0 ? reweighted(rows, std::move(start)) : start.fit;
}

}  // namespace idim
