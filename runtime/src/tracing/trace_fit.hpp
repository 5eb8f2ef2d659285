#pragma once

#include <Eigen/Core>
#include <vector>

#include "effect_candidate.hpp"
#include "idim/estimate.hpp"
#include "traced_log.hpp"

namespace idim {

/// Deviations of one joint's residual, away from reversals and at them [N*m or N]: at reversals sign(qd) never holds to
/// the noise, so these rows count by a deviation of their own.
struct row_noise {
    Eigen::VectorXd moving;
    Eigen::VectorXd reversal;
};

/// Values along the rows, [log][joint].
using log_series = std::vector<std::vector<Eigen::VectorXd>>;
using log_columns_set = std::vector<std::vector<Eigen::MatrixXd>>;

/// Columns of a candidate against a fit, on the rows it was fitted to: what they would remove from the residual.
struct projected_columns {
    std::vector<int> touched;
    log_columns_set weighted;     ///< [log][index into touched], rows x m, divided by the rows' deviations
    Eigen::MatrixXd on_basis;     ///< Q'X, k x m
    Eigen::VectorXd scale;        ///< [m] norms of the weighted columns
    Eigen::VectorXd coefficient;  ///< [m] least squares, 0 in directions that lie within the span of the model
    double gain = 0.0;            ///< decrease of the weighted squared residual
    int rank = 0;                 ///< directions outside the span of the model
};

/// Least squares of the rows of the logs that are not held back, columns of the model and of terms side by side,
/// weighted by row_noise; directions that the data does not excite are left at zero.
class trace_fit {
  public:
    trace_fit(const std::vector<traced_log>& logs, std::vector<effect_term> terms, row_noise noise);

    const std::vector<traced_log>& logs() const { return *logs_; }
    const std::vector<effect_term>& terms() const { return terms_; }
    const row_noise& noise() const { return noise_; }
    /// Model parameters [b].
    Eigen::VectorXd chi() const { return all_.head(base_); }
    /// Linear coefficients of term i; those of a term that is refitted for each log: of the first log.
    Eigen::VectorXd coefficients(std::size_t term) const;
    /// Place of the first coefficient of term i among all columns.
    Eigen::Index first_column(std::size_t term) const { return first_[term]; }
    /// Y less the prediction, of every log, held back or not [N*m or N].
    const log_series& residual() const { return residual_; }
    /// 1 / deviation of every row.
    const log_series& weight() const { return weight_; }
    /// Sum of the squared weighted residuals of the fitted logs.
    double loss() const { return loss_; }
    int parameters() const { return static_cast<int>(basis_scale_.cols()); }

    /// Columns of a candidate, `quick` for those without low-pass.
    projected_columns project(const effect_candidate& candidate, const Eigen::VectorXd& shape, bool quick) const;
    /// Residual of log l at every joint once the columns were added and everything fitted again.
    std::vector<Eigen::VectorXd> residual_with(const effect_candidate& candidate, const Eigen::VectorXd& shape,
                                               const projected_columns& columns, std::size_t log) const;

    /// Deviations of the residual as this fit leaves it, for the next one.
    row_noise estimated_noise() const;

    /// Deviation of a coefficient if the weighted residual were white.
    double white_deviation(Eigen::Index column) const { return basis_scale_.row(column).norm(); }
    /// Coefficients of all columns whose prediction is the combination k of the orthonormal basis.
    Eigen::VectorXd basis_times(const Eigen::VectorXd& k) const { return basis_scale_ * k; }

    /// Combinations of all columns, p x k, whose weighted rows are orthonormal: what the fit can tell apart.
    const Eigen::MatrixXd& combinations() const { return basis_scale_; }
    /// All columns [W X] of one joint in one log.
    const Eigen::MatrixXd& columns(std::size_t log, int joint) const {
        return columns_[log][static_cast<std::size_t>(joint)];
    }
    /// Orthonormal columns that span the weighted rows of one joint in one fitted log, rows x k.
    const Eigen::MatrixXd& basis(std::size_t log, int joint) const {
        return basis_[log][static_cast<std::size_t>(joint)];
    }
    /// 1 at the coefficients that are not fitted but known to be one, 0 elsewhere [p].
    Eigen::VectorXd known_coefficients() const;
    /// All coefficients, those of the model first.
    const Eigen::VectorXd& all_coefficients() const { return all_; }

  private:
    void build_columns();
    void solve();
    void refit_per_log_terms();

    const std::vector<traced_log>* logs_;
    std::vector<effect_term> terms_;
    row_noise noise_;
    Eigen::Index base_ = 0;
    std::vector<Eigen::Index> first_;
    log_columns_set columns_;
    log_series weight_;
    log_series residual_;
    log_columns_set basis_;        ///< [log][joint] orthonormal columns of the weighted rows; none for a log held back
    Eigen::MatrixXd basis_scale_;  ///< p x k: basis = weighted columns times this
    Eigen::VectorXd all_;
    double loss_ = 0.0;
};

/// Fits again until the deviations of the rows settle.
trace_fit fit_with_own_noise(const std::vector<traced_log>& logs, const std::vector<effect_term>& terms,
                             const row_noise* start = nullptr);

/// Errors over the logs that were fitted, or over those held back.
error_summary errors_of(const trace_fit& fit, bool held_back);

}  // namespace idim
