#include "base_parameters/column_selection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <optional>

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
    if (!result.kept.empty() && !result.dropped.empty()) {
        const Eigen::MatrixXd kept = W(Eigen::all, result.kept);
        const Eigen::MatrixXd dropped = W(Eigen::all, result.dropped);
        result.beta = kept.householderQr().solve(dropped);
    }
    return result;
}

namespace {

using field_rows = std::vector<std::vector<prime_field>>;

std::optional<std::size_t> pivot_row(const field_rows& rows, std::size_t first, std::size_t column) {
    for (std::size_t r = first; r < rows.size(); ++r) {
        if (!rows[r][column].is_zero()) {
            return r;
        }
    }
    return std::nullopt;
}

void eliminate(field_rows& rows, std::size_t pivot, std::size_t column) {
    const prime_field scale = rows[pivot][column].inverse();
    for (prime_field& element : rows[pivot]) {
        element = element * scale;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
        if (r == pivot || rows[r][column].is_zero()) {
            continue;
        }
        const prime_field factor = rows[r][column];
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            rows[r][c] = rows[r][c] - factor * rows[pivot][c];
        }
    }
}

}  // namespace

exact_selection select_exactly(field_rows rows, const std::vector<std::size_t>& preference) {
    exact_selection result;
    for (const std::size_t p : preference) {
        const bool is_zero_column = !pivot_row(rows, 0, p);
        if (is_zero_column) {
            continue;
        }
        const std::size_t rank = result.kept.size();
        if (const auto pivot = pivot_row(rows, rank, p)) {
            std::swap(rows[rank], rows[*pivot]);
            eliminate(rows, rank, p);
            result.kept.push_back(p);
        } else {
            result.dropped.push_back(p);
        }
    }
    for (std::size_t k = 0; k < result.kept.size(); ++k) {
        std::vector<prime_field> coefficients;
        for (const std::size_t d : result.dropped) {
            coefficients.push_back(rows[k][d]);
        }
        result.beta.push_back(coefficients);
    }
    return result;
}

}  // namespace idim::generator
