#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "trace_fit.hpp"

namespace idim {

/// What a candidate changes on one log that it was not fitted to: decrease of the weighted squared residual, and the
/// deviation of that sum, from blocks longer than the residual's correlation.
struct held_back_gain {
    double all = 0.0;
    double all_deviation = 0.0;
    double moving = 0.0;  ///< away from reversals
    double moving_deviation = 0.0;
};

/// What the data says of one candidate at its best shape.
struct effect_evidence {
    effect_term term;
    Eigen::VectorXd coefficient;      ///< linear coefficients from the fitted logs
    double gain = 0.0;                ///< decrease of the weighted squared residual of the fitted logs
    double correlation_length = 1.0;  ///< of the residual that the candidate leaves [rows]
    double freedom = 1.0;             ///< effective rows less parameters
    double f_statistic = 0.0;         ///< partial F on effective rows
    double p_value = 1.0;             ///< of that F, not corrected for the candidates tried
    bool within_span = false;         ///< its columns move, but only as the model's own do
    int shapes_tried = 1;
    std::vector<held_back_gain> held_back;  ///< per log held back
    double score = 0.0;  ///< decrease of the weighted squared residual of all logs, less the price of the parameters
    double explained_fraction = 0.0;  ///< of the residual variance on logs held back, at the joint where that is most

    /// Sum over logs in deviations of it.
    double z_all() const;
    double z_moving() const;
};

/// Rows of some joints over the fitted logs, and what a residual leaves in them.
struct row_count {
    double squared = 0.0;  ///< weighted squared residual
    double rows = 0.0;
    double effective = 0.0;   ///< as many as are independent
    double parameters = 0.0;  ///< the share of the model's parameters that these rows pay for

    /// Integrated autocorrelation time [rows].
    double length() const { return effective > 0.0 ? rows / effective : 1.0; }
};

row_count count_rows(const trace_fit& fit, const std::vector<int>& touched, const log_series& residual);

/// Partial F of m columns that lower the weighted squared residual by `gain`, on rows thinned past the correlation of
/// what they leave.
struct f_test {
    double statistic = 0.0;
    double freedom = 1.0;
    double p_value = 1.0;
};

f_test partial_f(const row_count& rows, double gain, double m);

/// Partial F of the candidate on as many rows as are independent: the rows of its joints over the integrated
/// autocorrelation time of the residual it leaves.
effect_evidence test_on_fitted(const trace_fit& fit, const effect_term& term, bool quick);

/// Adds what the logs held back say.
void test_on_held_back(const trace_fit& fit, effect_evidence& evidence);

/// Loss of residuals `first` less that of `second` on all logs (or those held back), in deviations of it: positive if
/// `second` fits better [Vuong 1989, on blocks longer than the correlation].
double loss_difference(const trace_fit& fit, const log_series& first, const log_series& second,
                       double correlation_length, bool held_back_only = false);

/// Residual of every log once the candidate was added.
log_series residual_with(const trace_fit& fit, const effect_evidence& evidence);

/// p of at least one such value among `tests` independent ones.
double corrected(double p_value, double tests);

/// Integrated autocorrelation time of residuals of one joint over the fitted logs [rows].
double correlation_length(const trace_fit& fit, const log_series& residual, int joint);

}  // namespace idim
