#pragma once

#include <vector>

#include "idim/estimate.hpp"
#include "idim/residual_test.hpp"
#include "row_source.hpp"
#include "stacked_qr.hpp"

namespace idim {

/// Throws std::invalid_argument if a block has not one W (rows x n_base), one Y (rows) and the place of every row per
/// joint: a broken invariant.
void check_shapes(const observation& rows);

/// Y - W chi, [joint][block].
joint_series residuals(const observation& rows, const Eigen::VectorXd& chi);

/// Deviation of each joint's residual: the root of its square over the joint's rows less the parameters that they
/// determine (parameter_share, stacked_qr.hpp).
std::vector<double> joint_deviations(const observation& rows, const joint_series& residual,
                                     const std::vector<double>& parameter_share);

/// Rows of joint j multiplied by factor[j].
joint_series scaled(joint_series series, const std::vector<double>& factor);

/// Errors of chi on the rows of the triangles.
error_summary errors(const joint_triangles& joints, const Eigen::VectorXd& chi);

/// A fit whose covariance, correlation_length and std_white are still empty, and the factor it came from.
struct weighted_solution {
    estimate fit;
    stacked_qr qr;
};

/// Least squares with the rows of joint j multiplied by joint_weight[j] > 0. The deviation of a joint is the root of
/// its squared residual over its rows less the parameters they determine (stacked_qr::parameter_share). Never throws
/// for the sake of the numbers: where they cannot be had, chi is empty and message says why.
weighted_solution solve_weighted(const joint_triangles& joints, const std::vector<double>& joint_weight);
weighted_solution solve_weighted(const observation& rows, const std::vector<double>& joint_weight);

/// solve_weighted with the deviations of its parameters. `joints`: the triangles of `rows`.
estimate weighted_fit(const row_source& rows, const joint_triangles& joints, const std::vector<double>& joint_weight);
estimate weighted_fit(const observation& rows, const std::vector<double>& joint_weight);

/// Ordinary or weighted least squares (estimate.hpp) of rows that come in parts. `joints`: their triangles.
estimate least_squares(const row_source& rows, const joint_triangles& joints, least_squares_method method);

/// find_essential (estimate.hpp) of rows that come in parts.
essential_parameters find_essential(const row_source& rows, const joint_triangles& joints, const estimate& full,
                                    double significance = 0.05);

/// test_residual (residual_test.hpp) of rows that come in parts.
std::vector<residual_test> test_residual(const row_source& rows, const estimate& fit);

/// Fills covariance, correlation_length and std_white of `result`, for chi that zeroes W' score: qr is the factor of
/// the rows weighted with joint_weight, of full rank; score the weighted residual, or a robust function of it
/// (sandwich.hpp).
void add_deviations(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                    const joint_series& score, estimate& result);

/// 1 / deviation, for a deviation of zero (a joint without torque, rows without noise) that of 1e-6 of the largest; 1
/// if all are zero: a perfect fit must not make the weights of the others vanish.
std::vector<double> weights_of(const std::vector<double>& joint_deviation);

}  // namespace idim
