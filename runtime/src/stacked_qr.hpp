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

/// The triangles of [W Y] of every joint, which hold all that least squares with any weights of the joints asks of the
/// rows: |Y - W chi| of a joint is |T [-chi; 1]|.
class joint_triangles {
  public:
    joint_triangles(int joints, int columns);

    /// Takes in rows of one joint.
    void add(std::size_t joint, const Eigen::Ref<const Eigen::MatrixXd>& W, const Eigen::Ref<const Eigen::VectorXd>& Y);

    int joints() const { return static_cast<int>(triangles_.size()); }
    int columns() const { return static_cast<int>(triangles_.front().cols()) - 1; }
    /// Upper, (b + 1) x (b + 1).
    const Eigen::MatrixXd& of(int joint) const { return triangles_[static_cast<std::size_t>(joint)]; }
    /// Rows taken in.
    Eigen::Index rows(int joint) const { return rows_[static_cast<std::size_t>(joint)]; }
    Eigen::Index rows() const;
    /// Whether all elements were finite.
    bool finite() const;
    /// |Y - W chi|^2 of a joint.
    double residual_square(int joint, const Eigen::VectorXd& chi) const;
    /// |Y|^2 of a joint.
    double torque_square(int joint) const;
    /// Those of the columns `kept` alone.
    joint_triangles with_columns(const std::vector<int>& kept) const;

  private:
    std::vector<Eigen::MatrixXd> triangles_;
    std::vector<Eigen::Index> rows_;
};

/// Of rows in memory.
joint_triangles triangles_of(const observation& rows);

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

/// The same with all rows of a joint multiplied by its weight.
stacked_qr factor(const joint_triangles& joints, const std::vector<double>& joint_weight);

/// A singular value of the scaled columns counts as zero below 1e-10 of the largest: filtered columns that depend on
/// one another agree to about 1e-13, while a parameter known through a direction of 1e-10 would have no digit left at
/// any torque noise. A column takes part in the null space if its component there exceeds 1e-5.
rank_report examine(const stacked_qr& qr);

}  // namespace idim
