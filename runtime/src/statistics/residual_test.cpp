#include "idim/residual_test.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "statistics/thinned_rows.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

constexpr Eigen::Index fewest_rows = 20;  // below, neither law of the statistics holds

/// Upper tail of chi squared.
double tail(double statistic, double freedom) {
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), statistic));
}

/// Residual of one joint on the samples of every block, zeros where rows were left out.
std::vector<Eigen::VectorXd> on_samples(const observation& rows, const joint_series& residual, std::size_t joint) {
    std::vector<Eigen::VectorXd> series;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        const observation_block& block = rows.blocks[i];
        Eigen::VectorXd values = Eigen::VectorXd::Zero(block.t.size());
        values(block.kept[joint]) = residual[joint][i];
        series.push_back(std::move(values));
    }
    return series;
}

/// sum e_k e_{k+l} over all pairs that both stand.
double product(const std::vector<Eigen::VectorXd>& series, Eigen::Index lag) {
    double sum = 0.0;
    for (const Eigen::VectorXd& values : series) {
        if (values.size() > lag) {
            sum += values.head(values.size() - lag).dot(values.tail(values.size() - lag));
        }
    }
    return sum;
}

void test_whiteness(const std::vector<Eigen::VectorXd>& series, Eigen::Index count, residual_test& result) {
    const double power = product(series, 0);
    if (power == 0.0 || count < fewest_rows) {
        return;
    }
    const auto n = static_cast<double>(count);
    result.lags = static_cast<int>(std::min(20.0, std::floor(10.0 * std::log10(n))));
    double Q = 0.0;
    for (int lag = 1; lag <= result.lags; ++lag) {
        const double correlation = product(series, lag) / power;
        result.lag_one = lag == 1 ? correlation : result.lag_one;
        Q += correlation * correlation / (n - lag);
    }
    result.whiteness_p = tail(n * (n + 2.0) * Q, result.lags);
}

void test_normality(const std::vector<double>& values, residual_test& result) {
    const Eigen::Map<const Eigen::ArrayXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
    result.thinned_rows = all.size();
    if (all.size() < fewest_rows) {
        return;
    }
    const Eigen::ArrayXd centred = all - all.mean();
    const double variance = centred.square().mean();
    if (variance == 0.0) {
        return;
    }
    result.skewness = centred.cube().mean() / std::pow(variance, 1.5);
    result.excess_kurtosis = centred.square().square().mean() / (variance * variance) - 3.0;
    const double statistic =
        static_cast<double>(all.size()) / 6.0 *
        (result.skewness * result.skewness + 0.25 * result.excess_kurtosis * result.excess_kurtosis);
    result.normality_p = tail(statistic, 2.0);
}

}  // namespace

std::vector<residual_test> test_residual(const observation& rows, const estimate& fit) {
    const joint_series residual = residuals(rows, fit.chi);
    std::vector<residual_test> tests;
    for (int j = 0; j < rows.dof; ++j) {
        const auto joint = static_cast<std::size_t>(j);
        residual_test test;
        test.correlation_length = fit.correlation_length[joint];
        test_whiteness(on_samples(rows, residual, joint), rows.rows(j), test);
        std::vector<double> thinned;
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            for (const Eigen::Index k : thinned_rows(rows.blocks[i].kept[joint], test.correlation_length)) {
                thinned.push_back(residual[joint][i][k]);
            }
        }
        test_normality(thinned, test);
        tests.push_back(test);
    }
    return tests;
}

}  // namespace idim
