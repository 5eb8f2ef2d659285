#pragma once

#include <Eigen/Core>
#include <vector>

#include "row_source.hpp"
#include "stacked_qr.hpp"

namespace idim {

/// Covariance of chi and what it was computed from.
struct sandwich {
    Eigen::MatrixXd covariance;              ///< b x b, positive semi-definite
    std::vector<double> correlation_length;  ///< per joint, autoregression::correlation_length of its residual
};

/// Covariance of chi robust to an autocorrelated residual,
///     C = (W'W)^-1 [sum over joints and lags of gamma_j(l) sum_k x_k x_{k+l}'] (W'W)^-1,
/// W weighted joint by joint, gamma_j the autocovariance of an autoregression fitted to the residual of joint j over
/// all blocks, never across a seam and across the gaps of left-out rows at the distance in time; all lags count, with
/// no bandwidth to choose, and the bracket is Z'Z >= 0 by construction (innovation_responses). Assumes the residual of
/// a joint stationary, the rate of the rows the same in all blocks.
///
/// The residual of a fit is less correlated than the noise, since the columns soak up what looks like them. Its
/// expected autocovariance follows exactly from Gamma - H Gamma - Gamma H + H Gamma H, H the hat matrix; the difference
/// is added back and the model fitted again, twice [Worsley et al. 2002, NeuroImage 15, section 2.3, for a regression
/// of the same kind]. This is the correction for degrees of freedom too.
///
/// Residuals of different joints at the same instant may be correlated (torque errors that several axes feel together):
/// the innovations of the joints' models are taken as correlated at lag 0, by their sample correlation over the
/// instants at which both joints have a row.
///
/// joint_weight: [n] factor of the rows of each joint; qr: the factor of those weighted rows, of full rank; residual:
/// the weighted residual, for a robust loss the weighted score of each row instead.
sandwich robust_covariance(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                           const joint_series& residual);

/// The same for the estimate that zeroes V' residual, V the columns of `instruments` weighted joint by joint: with
/// Q = V `instrument_inverse` orthonormal its error is `to_parameters` Q' rho. For the instrumental variable
/// `instrument_inverse` is R_V^-1 and `to_parameters` (Q_V' W)^-1, and with a white rho of one variance
/// C = sigma^2 (V'W)^-1 V'V (W'V)^-1 [Soderstrom and Stoica 1989, System Identification, section 8.2].
sandwich robust_covariance(const observation& instruments, const std::vector<double>& joint_weight,
                           const Eigen::MatrixXd& instrument_inverse, const Eigen::MatrixXd& to_parameters,
                           const joint_series& residual);

/// The same of rows that come in parts, in five passes over them. Correlations that reach over the end of a part count
/// as far as 1e-12 of them.
sandwich robust_covariance(const row_source& instruments, const std::vector<double>& joint_weight,
                           const Eigen::MatrixXd& instrument_inverse, const Eigen::MatrixXd& to_parameters,
                           const series_source& residual);

}  // namespace idim
