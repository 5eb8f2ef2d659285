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
    double largest_dropped = 0.0;  ///< the same of a dropped one; largest
};

/// QR of the columns in the order of preference (Gautier 1991): a diagonal element of R below `tolerance` of its
/// column's norm marks a column that depends on those before it. Gram-Schmidt, orthogonalised twice.
column_selection select_by_qr(const Eigen::MatrixXd& W, const std::vector<std::size_t>& preference, double tolerance);

/// beta [kept x dropped] of W_dropped = W_kept beta by least squares.
Eigen::MatrixXd express_by_qr(const Eigen::MatrixXd& W, const std::vector<std::size_t>& kept,
                              const std::vector<std::size_t>& dropped);

/// Matrix over a finite field, by rows.
class field_matrix {
  public:
    explicit field_matrix(std::size_t columns) : columns_(columns) {}

    std::size_t rows() const { return columns_ == 0 ? 0 : elements_.size() / columns_; }
    std::size_t columns() const { return columns_; }
    prime_field* row(std::size_t r) { return elements_.data() + r * columns_; }
    const prime_field* row(std::size_t r) const { return elements_.data() + r * columns_; }

    void append(const std::vector<prime_field>& row) { elements_.insert(elements_.end(), row.begin(), row.end()); }

  private:
    std::size_t columns_;
    std::vector<prime_field> elements_;
};

/// The same decision over a finite field, with the coefficients of the dropped columns in the kept ones.
struct exact_selection {
    std::vector<std::size_t> kept, dropped;
    /// beta[k][d]: dropped column d = sum over k of beta[k][d] kept column k
    std::vector<std::vector<prime_field>> beta;
};

/// Elimination with the sparsest row that has the column as pivot row: rows of outer joints have few columns, and what
/// they eliminate fills in nothing.
exact_selection select_exactly(field_matrix W, const std::vector<std::size_t>& preference);

}  // namespace idim::generator
