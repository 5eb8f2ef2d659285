#include "idim/total_least_squares.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>

#include "sandwich.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

double weighted_square(const observation& rows, const std::vector<double>& weight) {
    double sum = 0.0;
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < weight.size(); ++j) {
            sum += (weight[j] * block.Y[j]).squaredNorm();
        }
    }
    return sum;
}

}  // namespace

estimate total_least_squares(const observation& rows) {
    const estimate ordinary = solve_weighted(rows, std::vector<double>(static_cast<std::size_t>(rows.dof), 1.0)).fit;
    if (ordinary.chi.size() == 0) {
        return ordinary;
    }
    const std::vector<double> weight = weights_of(ordinary.joint_deviation);
    weighted_solution solution = solve_weighted(rows, weight);
    estimate result = std::move(solution.fit);
    const stacked_qr& qr = solution.qr;
    const Eigen::Index b = qr.R.rows();
    const double Y_square = weighted_square(rows, weight);
    const double Y_norm = std::sqrt(Y_square);
    // Triangle of the scaled [W Y]: R, z and what the rows leave of Y.
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(b + 1, b + 1);
    triangle.topLeftCorner(b, b) = qr.R;
    triangle.col(b).head(b) = qr.z / Y_norm;
    triangle(b, b) = std::sqrt(std::max(Y_square - qr.z.squaredNorm(), 0.0)) / Y_norm;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangle, Eigen::ComputeFullV);
    const Eigen::VectorXd v = svd.matrixV().col(b);
    constexpr double no_solution = 1e-8;
    if (std::abs(v[b]) < no_solution) {
        result.chi.resize(0);
        result.converged = false;
        result.message = "no total least squares solution: the smallest change would leave the torque as it is";
        return result;
    }
    result.chi = (-Y_norm / v[b]) * v.head(b).cwiseQuotient(qr.column_norm);
    const double s = svd.singularValues()[b];
    const Eigen::MatrixXd normal =
        qr.R.transpose() * qr.R - s * s * Eigen::MatrixXd::Identity(b, b);  // positive: s is below R's own smallest
    const Eigen::MatrixXd to_parameters =
        qr.column_norm.cwiseInverse().asDiagonal() * normal.ldlt().solve(Eigen::MatrixXd(qr.R.transpose()));
    const joint_series score = scaled(residuals(rows, result.chi), weight);
    sandwich robust = robust_covariance(rows, weight, qr.inverse(), to_parameters, score);
    result.covariance = std::move(robust.covariance);
    result.correlation_length = std::move(robust.correlation_length);
    double sum = 0.0;
    for (const auto& segments : score) {
        for (const Eigen::VectorXd& segment : segments) {
            sum += segment.squaredNorm();
        }
    }
    result.std_white = std::sqrt(sum / static_cast<double>(rows.rows() - b)) * to_parameters.rowwise().norm();
    result.joint_deviation = joint_deviations(rows, residuals(rows, result.chi), qr.parameter_share());
    result.residual = errors(rows, result.chi);
    result.message = fmt::format("{} parameters from {} rows, total least squares", b, rows.rows());
    return result;
}

}  // namespace idim
