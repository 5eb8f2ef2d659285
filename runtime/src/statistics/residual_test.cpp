#include "idim/residual_test.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "weighted_fit.hpp"

namespace idim {

namespace {

constexpr Eigen::Index fewest_rows = 20;  // below, neither law of the statistics holds

/// Upper tail of chi squared.
double tail(double statistic, double freedom) {
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), statistic));
}

/// What the tests ask of one joint's residual, in one pass over it.
class residual_sums {
  public:
    /// Rows at least `distance` samples apart count as independent.
    explicit residual_sums(Eigen::Index distance) : distance_(distance) {}

    void begin_log() {
        last_.resize(0);
        place_ = 0;
        next_ = 0;
    }

    void add(const gapped_series& piece) {
        Eigen::VectorXd values(last_.size() + piece.value.size());
        values << last_, piece.value;
        for (Eigen::Index lag = 0; lag <= most_lags; ++lag) {
            const Eigen::Index from = std::max(last_.size(), lag);
            const Eigen::Index pairs = std::max(values.size() - from, Eigen::Index{0});
            products_[lag] += values.segment(from, pairs).dot(values.segment(from - lag, pairs));
        }
        last_ = values.tail(std::min(most_lags, values.size()));
        for (Eigen::Index k = 0; k < piece.value.size(); ++k, ++place_) {
            if (piece.present[k] > 0.0) {
                ++rows_;
                add_thinned(piece.value[k]);
            }
        }
    }

    void test_whiteness(residual_test& result) const;
    void test_normality(residual_test& result) const;

  private:
    static constexpr Eigen::Index most_lags = 20;

    void add_thinned(double value) {
        if (place_ >= next_) {
            next_ = place_ + distance_;
            ++thinned_;
            long double power = 1.0L;
            for (long double& sum : powers_) {
                sum += power *= value;
            }
        }
    }

    Eigen::Index distance_;
    Eigen::Index rows_ = 0;
    Eigen::Index thinned_ = 0;
    Eigen::Index place_ = 0;  ///< of the sample in its log
    Eigen::Index next_ = 0;   ///< from which on a row counts as independent of the last that did
    Eigen::VectorXd last_;
    Eigen::Array<double, most_lags + 1, 1> products_ = Eigen::Array<double, most_lags + 1, 1>::Zero();
    std::array<long double, 4> powers_ = {};  ///< sums of value^1..4; long double, for the mean is small beside them
};

void residual_sums::test_whiteness(residual_test& result) const {
    const double power = products_[0];
    if (power == 0.0 || rows_ < fewest_rows) {
        return;
    }
    const auto n = static_cast<double>(rows_);
    result.lags = static_cast<int>(std::min(static_cast<double>(most_lags), std::floor(10.0 * std::log10(n))));
    double Q = 0.0;
    for (int lag = 1; lag <= result.lags; ++lag) {
        const double correlation = products_[lag] / power;
        result.lag_one = lag == 1 ? correlation : result.lag_one;
        Q += correlation * correlation / (n - lag);
    }
    result.whiteness_p = tail(n * (n + 2.0) * Q, result.lags);
}

void residual_sums::test_normality(residual_test& result) const {
    result.thinned_rows = thinned_;
    if (thinned_ < fewest_rows) {
        return;
    }
    const auto n = static_cast<long double>(thinned_);
    const long double mean = powers_[0] / n;
    const long double square = powers_[1] / n;
    const long double cube = powers_[2] / n;
    const long double variance = square - mean * mean;
    if (!(variance > 0.0L)) {
        return;
    }
    const long double third = cube - 3.0L * mean * square + 2.0L * mean * mean * mean;
    const long double fourth =
        powers_[3] / n - 4.0L * mean * cube + 6.0L * mean * mean * square - 3.0L * mean * mean * mean * mean;
    result.skewness = static_cast<double>(third / std::pow(variance, 1.5L));
    result.excess_kurtosis = static_cast<double>(fourth / (variance * variance)) - 3.0;
    const double statistic =
        static_cast<double>(thinned_) / 6.0 *
        (result.skewness * result.skewness + 0.25 * result.excess_kurtosis * result.excess_kurtosis);
    result.normality_p = tail(statistic, 2.0);
}

}  // namespace

std::vector<residual_test> test_residual(const row_source& rows, const estimate& fit) {
    std::vector<residual_sums> sums;
    for (const double length : fit.correlation_length) {
        sums.emplace_back(static_cast<Eigen::Index>(std::ceil(length)));
    }
    const std::vector<double> unweighted(sums.size(), 1.0);
    rows.residual(fit.chi, unweighted)->visit([&](const std::vector<gapped_series>& joints, bool begins) {
        for (std::size_t j = 0; j < sums.size(); ++j) {
            if (begins) {
                sums[j].begin_log();
            }
            sums[j].add(joints[j]);
        }
    });
    std::vector<residual_test> tests;
    for (std::size_t j = 0; j < sums.size(); ++j) {
        residual_test test;
        test.correlation_length = fit.correlation_length[j];
        sums[j].test_whiteness(test);
        sums[j].test_normality(test);
        tests.push_back(test);
    }
    return tests;
}

std::vector<residual_test> test_residual(const observation& rows, const estimate& fit) {
    return test_residual(resident_rows(rows), fit);
}

}  // namespace idim
