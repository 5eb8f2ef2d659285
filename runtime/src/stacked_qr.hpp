#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/observation.hpp"

namespace idim {

/// One vector per joint and block, [joint][block], of as many entries as that joint has rows there.
using joint_series = std::vector<std::vector<Eigen::VectorXd>>;

/// The triangular factor of the weighted rows, Q'[W Y] = [R z; 0 |Y - W chi|], columns of W divided by their norm. Each
/// joint of each block is factored by Householder reflections over the columns it feels, then the triangles are stacked
/// and factored again [Demmel, Grigori, Hoemmen and Langou 2012, sequential TSQR]: the rows are read once and never
/// copied as a whole.
struct stacked_qr {
    Eigen::MatrixXd R;                    ///< b x b, upper
    Eigen::VectorXd z;                    ///< [b]
    Eigen::VectorXd column_norm;          ///< [b] norms of the weighted columns, 1 for a column of zeros
    std::vector<Eigen::MatrixXd> joints;  ///< per joint: triangle of its own weighted, scaled columns, b x b

    /// R^-1 z in the units of the parameters; R must be of full rank.
    Eigen::VectorXd solve() const;
    /// D^-1 R^-1, so that (W'W)^-1 = X X' [b x b]; R must be of full rank.
    Eigen::MatrixXd inverse() const;
    /// Part of the b parameters that the rows of each joint determine, trace of its block of the hat matrix; the sum is
    /// b.
    std::vector<double> parameter_share() const;
};

/// What the singular values of the factor say.
struct rank_report {
    int rank = 0;
    double condition_number = 0.0;  ///< columns in the units of the parameters
    double scaled_condition_number =
        0.0;  ///< columns of norm 1; both at most 1 / machine epsilon, beyond which rounding decides
    std::vector<int> not_excited;  ///< columns that take part in the null space
};

/// Factors the rows, row k of joint j in block i multiplied by weights[j][i][k].
stacked_qr factor(const observation& rows, const joint_series& weights);

/// Weights that are the same for all rows of a joint.
joint_series uniform_weights(const observation& rows, const std::vector<double>& joint_weight);

/// A singular value of the scaled columns counts as zero below 1e-10 of the largest: filtered columns that depend on
/// one another agree to about 1e-13, while a parameter known through a direction of 1e-10 would have no digit left at
/// any torque noise. A column takes part in the null space if its component there exceeds 1e-5.
rank_report examine(const stacked_qr& qr);

}  // namespace idim
