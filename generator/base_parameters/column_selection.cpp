#include "base_parameters/column_selection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace idim::generator {

column_selection select_by_qr(const Eigen::MatrixXd& W, const std::vector<std::size_t>& preference, double tolerance) {
    column_selection result;
    Eigen::MatrixXd Q(W.rows(), static_cast<Eigen::Index>(preference.size()));
    Eigen::Index rank = 0;
    // Columns that vanish identically hold rounding errors of the largest ones.
    const double vanishing = tolerance * W.colwise().norm().maxCoeff();
    for (const std::size_t p : preference) {
        Eigen::VectorXd v = W.col(static_cast<Eigen::Index>(p));
        const double norm = v.norm();
        if (norm <= vanishing) {
            continue;
        }
        v /= norm;
        for (int pass = 0; pass < 2; ++pass) {
            v -= Q.leftCols(rank) * (Q.leftCols(rank).transpose() * v);
        }
        const double rest = v.norm();
        if (rest > tolerance && rank < W.rows()) {
            Q.col(rank++) = v / rest;
            result.kept.push_back(p);
            result.smallest_kept = std::min(result.smallest_kept, rest);
        } else {
            result.dropped.push_back(p);
            result.largest_dropped = std::max(result.largest_dropped, rest);
        }
    }
    return result;
}

Eigen::MatrixXd express_by_qr(const Eigen::MatrixXd& W, const std::vector<std::size_t>& kept,
                              const std::vector<std::size_t>& dropped) {
    const Eigen::MatrixXd basis = W(Eigen::all, kept);
    const Eigen::MatrixXd dependent = W(Eigen::all, dropped);
    return basis.householderQr().solve(dependent);
}

namespace {

/// Rows of a matrix under elimination, sparsest first.
class elimination {
  public:
    explicit elimination(field_matrix W) : W_(std::move(W)), order_(W_.rows()) {
        std::vector<std::size_t> filled(W_.rows());
        for (std::size_t r = 0; r < W_.rows(); ++r) {
            filled[r] = static_cast<std::size_t>(
                std::count_if(W_.row(r), W_.row(r) + W_.columns(), [](prime_field v) { return !v.is_zero(); }));
        }
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(),
                         [&filled](std::size_t a, std::size_t b) { return filled[a] < filled[b]; });
    }

    prime_field at(std::size_t r, std::size_t column) const { return W_.row(order_[r])[column]; }

    bool is_zero_column(std::size_t column) const { return !find(0, column); }

    /// Makes the column that of a unit matrix in row `rank`, with a row from there on; false where there is none.
    bool reduce(std::size_t rank, std::size_t column) {
        const auto pivot = find(rank, column);
        if (!pivot) {
            return false;
        }
        std::rotate(order_.begin() + static_cast<std::ptrdiff_t>(rank),
                    order_.begin() + static_cast<std::ptrdiff_t>(*pivot),
                    order_.begin() + static_cast<std::ptrdiff_t>(*pivot) + 1);
        const std::vector<std::size_t> filled = scale(W_.row(order_[rank]), column);
        for (std::size_t r = 0; r < order_.size(); ++r) {
            if (r != rank) {
                subtract(W_.row(order_[rank]), filled, column, W_.row(order_[r]));
            }
        }
        return true;
    }

  private:
    std::optional<std::size_t> find(std::size_t first, std::size_t column) const {
        for (std::size_t r = first; r < order_.size(); ++r) {
            if (!at(r, column).is_zero()) {
                return r;
            }
        }
        return std::nullopt;
    }

    /// Divides a row by its element in a column. Returns the columns where it is not zero.
    std::vector<std::size_t> scale(prime_field* row, std::size_t column) const {
        const prime_field factor = row[column].inverse();
        std::vector<std::size_t> filled;
        for (std::size_t c = 0; c < W_.columns(); ++c) {
            if (!row[c].is_zero()) {
                row[c] = row[c] * factor;
                filled.push_back(c);
            }
        }
        return filled;
    }

    static void subtract(const prime_field* pivot, const std::vector<std::size_t>& filled, std::size_t column,
                         prime_field* row) {
        const prime_field factor = row[column];
        if (!factor.is_zero()) {
            for (const std::size_t c : filled) {
                row[c] = row[c] - factor * pivot[c];
            }
        }
    }

    field_matrix W_;
    std::vector<std::size_t> order_;
};

}  // namespace

exact_selection select_exactly(field_matrix W, const std::vector<std::size_t>& preference) {
    exact_selection result;
    elimination rows(std::move(W));
    for (const std::size_t p : preference) {
        if (rows.reduce(result.kept.size(), p)) {
            result.kept.push_back(p);
        } else if (!rows.is_zero_column(p)) {
            result.dropped.push_back(p);
        }
    }
    for (std::size_t k = 0; k < result.kept.size(); ++k) {
        std::vector<prime_field> coefficients;
        for (const std::size_t d : result.dropped) {
            coefficients.push_back(rows.at(k, d));
        }
        result.beta.push_back(coefficients);
    }
    return result;
}

}  // namespace idim::generator
