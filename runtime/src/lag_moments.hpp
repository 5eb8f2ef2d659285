#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/autocorrelation.hpp"

namespace idim {

/// The products of a series' samples with those before them that Burg's recursion needs, summed in one pass over a
/// series that comes in pieces: the prediction errors of every order are linear in windows of successive samples, so
/// that their sums of squares and products are quadratic forms of sum w w' over the windows w. Sums are held in long
/// double, since the recursion takes differences of them.
class lag_moments {
  public:
    /// For reflection coefficients of orders 1..lags.
    explicit lag_moments(Eigen::Index lags);

    /// A new segment begins: what follows has nothing before it.
    void begin_segment();
    /// The next piece of the segment.
    void add(const gapped_series& piece);

    Eigen::Index lags() const { return lags_; }
    Eigen::Index samples() const { return samples_; }
    /// Pairs (k, k + l) of present samples at lags 0..lags, [lags + 1].
    const Eigen::VectorXd& pairs() const { return pairs_; }
    /// Autocovariance at lags 0..lags of Burg's reflection coefficients (autocorrelation.hpp), [lags + 1].
    Eigen::VectorXd autocovariance() const;

  private:
    using matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    using vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

    void add_pairs(const Eigen::VectorXd& present, Eigen::Index first);
    void add_full_windows(const vector& value, Eigen::Index begin, Eigen::Index end);
    void keep_history(const Eigen::VectorXd& value, const Eigen::VectorXd& present);

    Eigen::Index lags_;
    Eigen::Index samples_ = 0;
    long double power_ = 0.0L;
    Eigen::VectorXd pairs_;
    std::vector<matrix> windows_;      ///< [q]: sum w w' of the longest windows, q + 1 samples of a run, the last first
    std::vector<Eigen::Index> count_;  ///< [q]: windows summed
    gapped_series history_;            ///< the last samples of the segment, at most `lags`
    Eigen::Index run_ = 0;             ///< samples without a gap that end with the history
};

/// Coefficients of an autoregression of one order more, by Levinson's recursion.
template <typename Vector>
Vector raised(const Vector& a, typename Vector::Scalar reflection) {
    Vector next(a.size() + 1);
    next << a - reflection * a.reverse(), reflection;
    return next;
}

}  // namespace idim
