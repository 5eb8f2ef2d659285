#pragma once

#include <string>
#include <vector>

#include "stacked_qr.hpp"

namespace idim {

/// The two factorisations W = Q_W R_W and V = Q_V R_V of [IV 34], rows weighted joint by joint, and what they give:
/// Q_V'Y = Q_V'Q_W R_W chi. One pass over the rows: the triangle of [V W Y] holds R_V, Q_V'W and Q_V'Y in its first b
/// rows and, with those below, R_W.
struct instrument_qr {
    Eigen::MatrixXd R_V;                           ///< b x b, columns scaled by instrument_norm
    Eigen::MatrixXd S;                             ///< Q_V' W, b x b, columns scaled by column_norm
    Eigen::VectorXd z;                             ///< [b] Q_V' Y
    Eigen::VectorXd column_norm;                   ///< [b] of the weighted W
    Eigen::VectorXd instrument_norm;               ///< [b] of the weighted V
    rank_report regressor;                         ///< of R_W
    rank_report instruments;                       ///< of R_V
    double smallest_cosine = 0.0;                  ///< of the angles between the spans of V and W; 0 where a rank lacks
    std::vector<Eigen::MatrixXd> joint_triangles;  ///< per joint: triangle of its own weighted, scaled V, b x b

    Eigen::Index least_explained = 0;  ///< parameter with the largest part in the direction of that largest angle

    /// r cos^2 / sin^2 of the largest angle, at least as large as any F of the first stage along it; r rows.
    double first_stage(Eigen::Index rows) const;
    bool full_rank() const;
    /// (Q_V'W)^-1 Q_V'Y; needs full rank.
    Eigen::VectorXd solve() const;
    /// R_V^-1 in units, so that V R_V^-1 is orthonormal.
    Eigen::MatrixXd instrument_inverse() const;
    /// (Q_V'W)^-1 in units.
    Eigen::MatrixXd to_parameters() const;
    /// Part of the b parameters that the rows of each joint determine (stacked_qr::parameter_share), of V.
    std::vector<double> parameter_share() const;
};

/// `instruments` has the rows of `rows`; its Y is not read. joint_weight: [n].
instrument_qr factor(const observation& rows, const observation& instruments, const std::vector<double>& joint_weight);

}  // namespace idim
