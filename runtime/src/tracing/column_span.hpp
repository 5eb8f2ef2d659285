#pragma once

#include <Eigen/Core>

namespace idim {

/// Orthonormal columns of the span of A; directions below 1e-6 of the largest count as none.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& A);

/// What of the columns of A lies outside a span of orthonormal columns.
Eigen::MatrixXd outside(const Eigen::MatrixXd& span, const Eigen::MatrixXd& A);

}  // namespace idim
