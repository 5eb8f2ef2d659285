#pragma once

#include <Eigen/Core>
#include <vector>

namespace idim {

/// Samples of a series on a uniform grid, some of which may be missing: the gaps of left-out rows keep the distance in
/// time of what stands on their two sides.
struct gapped_series {
    Eigen::VectorXd value;    ///< 0 where missing
    Eigen::VectorXd present;  ///< 1, or 0 where missing
};

/// A series without gaps.
gapped_series complete_series(const Eigen::VectorXd& value);

/// Samples present in all segments.
Eigen::Index samples_of(const std::vector<gapped_series>& segments);

/// Stationary autoregressive model of a series, e_k = sum_i a_i e_{k-i} + eps_k with eps white. Fitted by the
/// Yule-Walker equations, so it is stable and its autocovariance agrees with the sample's up to the order. An
/// autoregressive spectrum is positive at every frequency, hence every variance computed with it is; and it follows a
/// slowly decaying correlation with far less bias than a truncated (Bartlett, Newey-West) sum [den Haan and Levin 1997,
/// "A practitioner's guide to robust covariance matrix estimation", Handbook of Statistics 15, the VARHAC estimator].
struct autoregression {
    Eigen::VectorXd a;        ///< [p] coefficients of lags 1..p
    Eigen::VectorXd rho;      ///< [p] autocorrelation at lags 1..p
    double variance = 0.0;    ///< of the series, [unit^2]
    double innovation = 0.0;  ///< variance of eps, [unit^2]

    Eigen::Index order() const { return a.size(); }
    /// Autocorrelation at lags 0..lags, [lags + 1].
    Eigen::VectorXd autocorrelation(Eigen::Index lags) const;
    /// Rows after which the response to one innovation stays below `forgotten` of it, at most `limit`.
    Eigen::Index memory(Eigen::Index limit, double forgotten = 1e-4) const;
    /// Integrated autocorrelation time [rows], >= 1: the larger of 1 + 2 sum rho(l), by which the variance of a mean
    /// grows, and 1 + 2 sum rho(l)^2, which also sees an oscillation whose rho(l) sum to nothing. At most `limit`.
    double correlation_length(Eigen::Index limit) const;
};

/// Autocovariance about zero at lags 0..lags, pooled over segments: that of Burg's reflection coefficients, taken over
/// all runs of samples without a seam or a gap [de Waele and Broersen 2000, "The Burg algorithm for segments", IEEE
/// Trans. Signal Processing 48]. Positive semi-definite by construction, and not drawn to zero by gaps and seams:
/// dividing sums of products by their pairs would lack the one, dividing by the samples the other. A lag for which less
/// than a quarter of the samples have so many before them is extrapolated from the shorter ones. Zeros if there are no
/// samples.
Eigen::VectorXd autocovariance(const std::vector<gapped_series>& segments, Eigen::Index lags);

/// Highest order worth trying, 10 log10 of the number of samples [Schwert 1989; the default of R's ar()], but at most a
/// quarter of the mean segment.
Eigen::Index highest_order(Eigen::Index samples, std::size_t segments);
Eigen::Index highest_order(const std::vector<gapped_series>& segments);

/// Yule-Walker fit to the autocovariance at lags 0..highest order of `samples` samples, by Levinson's recursion, order
/// chosen by the corrected Akaike criterion [Hurvich and Tsai 1989]. An autocovariance that stops being positive
/// definite ends the recursion there, but at lag 1, where the correlation is taken as 1 - 1 / samples: what does not
/// change from one sample to the next is not white. A series of zeros gives order 0 and no variance.
autoregression fit_autoregression(const Eigen::VectorXd& autocovariance, Eigen::Index samples);

/// Innovations of a series that comes in pieces. Missing samples are replaced by their prediction: their own innovation
/// is 0, those after a gap hold the error of that prediction too.
class innovation_filter {
  public:
    explicit innovation_filter(autoregression model);

    /// A new segment begins: what follows has nothing before it.
    void begin_segment();
    /// Of every sample of the next piece; 0 for the first p of a segment, which have no full past.
    Eigen::VectorXd next(const gapped_series& piece);

  private:
    autoregression model_;
    Eigen::VectorXd filled_;  ///< the last p samples, where missing as predicted
};

/// Innovations eps_k of a segment [n - p]; the first p samples have no full past and are left out.
Eigen::VectorXd innovations(const autoregression& model, const gapped_series& segment);

/// Responses Z of the columns of X (n x b) to one innovation, ((n + tail) x b): with it X' Gamma X = innovation * Z'Z,
/// Gamma the n x n Toeplitz autocovariance of the model. Row m belongs to the innovation of sample m - tail. `tail`
/// must be at least the memory of the model for the equality to hold.
/// Rows of zeros in X are samples that do not count, so that gaps need nothing else.
Eigen::MatrixXd innovation_responses(const autoregression& model, const Eigen::MatrixXd& X, Eigen::Index tail);

/// Gamma X (n x b) from the responses Z = innovation_responses(model, X, tail).
Eigen::MatrixXd covariance_times(const autoregression& model, const Eigen::MatrixXd& Z, Eigen::Index n);

/// Sum over columns c of sum_k X(k, c) X(k + l, c) at lags 0..lags, [lags + 1].
Eigen::VectorXd lagged_products(const Eigen::MatrixXd& X, Eigen::Index lags);

/// The same over the pairs whose earlier row is one of first..first+count-1.
Eigen::VectorXd lagged_products(const Eigen::MatrixXd& X, Eigen::Index lags, Eigen::Index first, Eigen::Index count);

}  // namespace idim
