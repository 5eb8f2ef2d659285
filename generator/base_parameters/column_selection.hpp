#pragma once

#include <Eigen/Core>
#include <vector>

#include "base_parameters/prime_field.hpp"

namespace idim::generator {

/// Which columns of a sampled regressor are independent, taken greedily in an order of preference.
struct column_selection {
    std::vector<std::size_t> kept;  ///< in the order of preference
    std::vector<std::size_t>
        dropped;                   ///< in the order of preference; columns that are zero throughout are in neither list
    double smallest_kept = 1.0;    ///< part of a kept column outside the span of those before it, relative; smallest
    Eigen::MatrixXd beta;          ///< kept x dropped: W_dropped = W_kept beta, by least squares
    double largest_dropped = 0.0;  ///< the same of a dropped one; largest
};

/// QR of the columns in the order of preference (Gautier 1991): a diagonal element of R below `tolerance` of its
/// column's norm marks a column that depends on those before it. Gram-Schmidt, orthogonalised twice.
column_selection select_by_qr(const Eigen::MatrixXd& W, const std::vector<std::size_t>& preference, double tolerance);

/// The same decision over a finite field, with the coefficients of the dropped columns in the kept ones.
struct exact_selection {
    std::vector<std::size_t> kept, dropped;
    /// beta[k][d]: dropped column d = sum over k of beta[k][d] kept column k
    std::vector<std::vector<prime_field>> beta;
};

/// `rows`: a matrix by rows.
exact_selection select_exactly(std::vector<std::vector<prime_field>> rows, const std::vector<std::size_t>& preference);

}  // namespace idim::generator
