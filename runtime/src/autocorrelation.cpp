#include "idim/autocorrelation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lag_moments.hpp"

namespace idim {

namespace {

/// x_m = sum_i a_i x_{m+i}, over `tail` rows before the first one of Z and over the rows that already hold the input.
void filter_backward(const Eigen::VectorXd& a, Eigen::Ref<Eigen::VectorXd> z) {
    for (Eigen::Index m = z.size() - 2; m >= 0; --m) {
        const Eigen::Index past = std::min(a.size(), z.size() - 1 - m);
        z[m] += a.head(past).dot(z.segment(m + 1, past));
    }
}

/// x_m = sum_i a_i x_{m-i}, over rows that already hold the input.
void filter_forward(const Eigen::VectorXd& a, Eigen::Ref<Eigen::VectorXd> z) {
    for (Eigen::Index m = 1; m < z.size(); ++m) {
        const Eigen::Index past = std::min(a.size(), m);
        z[m] += a.head(past).dot(z.segment(m - past, past).reverse());
    }
}

/// Corrected Akaike criterion of an autoregression with variance v of the innovations.
double akaike(double v, Eigen::Index order, Eigen::Index samples) {
    const double n = static_cast<double>(samples);
    const double parameters = static_cast<double>(order) + 1.0;
    return n * std::log(v) + 2.0 * parameters * n / (n - parameters - 1.0);
}

}  // namespace

Eigen::VectorXd autoregression::autocorrelation(Eigen::Index lags) const {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(lags + 1);
    r[0] = 1.0;
    for (Eigen::Index l = 1; l <= lags; ++l) {
        if (l <= order()) {
            r[l] = rho[l - 1];
            continue;
        }
        for (Eigen::Index i = 0; i < order(); ++i) {
            r[l] += a[i] * r[l - 1 - i];
        }
    }
    return r;
}

Eigen::Index autoregression::memory(Eigen::Index limit, double forgotten) const {
    if (order() == 0) {
        return 0;
    }
    Eigen::VectorXd last = Eigen::VectorXd::Unit(order(), 0);  // response at m - 1, m - 2, ...
    Eigen::Index quiet = 0;
    for (Eigen::Index m = 1; m <= limit + order(); ++m) {
        const double response = a.dot(last);
        std::copy_backward(last.begin(), last.end() - 1, last.end());
        last[0] = response;
        quiet = std::abs(response) < forgotten ? quiet + 1 : 0;
        if (quiet >= order()) {
            return std::min(limit, m - order());
        }
    }
    return limit;
}

double autoregression::correlation_length(Eigen::Index limit) const {
    if (order() == 0) {
        return 1.0;
    }
    const double gain = 1.0 - a.sum();
    const double at_zero = innovation / (variance * gain * gain);
    const double squared = 2.0 * autocorrelation(memory(limit) + order()).squaredNorm() - 1.0;
    return std::clamp(std::max(at_zero, squared), 1.0, std::max(1.0, static_cast<double>(limit)));
}

gapped_series complete_series(const Eigen::VectorXd& value) {
    return {value, Eigen::VectorXd::Ones(value.size())};
}

Eigen::Index samples_of(const std::vector<gapped_series>& segments) {
    Eigen::Index samples = 0;
    for (const gapped_series& segment : segments) {
        samples += (segment.present.array() > 0.0).count();
    }
    return samples;
}

Eigen::VectorXd autocovariance(const std::vector<gapped_series>& segments, Eigen::Index lags) {
    lag_moments moments(lags);
    for (const gapped_series& segment : segments) {
        moments.begin_segment();
        moments.add(segment);
    }
    return moments.autocovariance();
}

Eigen::Index highest_order(Eigen::Index samples, std::size_t segments) {
    if (samples < 1) {
        return 0;
    }
    const auto n = static_cast<double>(samples);
    return static_cast<Eigen::Index>(std::min(10.0 * std::log10(n), n / static_cast<double>(segments) / 4.0));
}

Eigen::Index highest_order(const std::vector<gapped_series>& segments) {
    return highest_order(samples_of(segments), segments.size());
}

autoregression fit_autoregression(const Eigen::VectorXd& autocovariance, Eigen::Index samples) {
    autoregression best;
    best.variance = std::max(autocovariance[0], 0.0);
    best.innovation = best.variance;
    if (best.variance == 0.0 || samples < 4) {
        return best;
    }
    const Eigen::VectorXd r = autocovariance / best.variance;
    double best_criterion = akaike(1.0, 0, samples);
    double v = 1.0;
    Eigen::VectorXd a(0);
    for (Eigen::Index p = 1; p < r.size() && p + 2 < samples; ++p) {
        double reflection = (r[p] - a.dot(r.segment(1, p - 1).reverse())) / v;
        if (p == 1) {
            const double highest = 1.0 - 1.0 / static_cast<double>(samples);
            reflection = std::clamp(reflection, -highest, highest);
        }
        v *= 1.0 - reflection * reflection;
        if (!(v > 1e-12)) {
            break;
        }
        a = raised(a, reflection);
        const double criterion = akaike(v, p, samples);
        if (criterion < best_criterion) {
            best_criterion = criterion;
            best.a = a;
            best.rho = r.segment(1, p);
            best.innovation = v * best.variance;
        }
    }
    return best;
}

innovation_filter::innovation_filter(autoregression model) : model_(std::move(model)) {}

void innovation_filter::begin_segment() {
    filled_.resize(0);
}

Eigen::VectorXd innovation_filter::next(const gapped_series& piece) {
    const Eigen::Index p = model_.order();
    const Eigen::Index before = filled_.size();
    Eigen::VectorXd filled(before + piece.value.size());
    filled << filled_, piece.value;
    Eigen::VectorXd eps = Eigen::VectorXd::Zero(piece.value.size());
    for (Eigen::Index k = 0; k < eps.size(); ++k) {
        const Eigen::Index at = before + k;
        if (at < p) {
            continue;
        }
        const double predicted = model_.a.dot(filled.segment(at - p, p).reverse());
        if (piece.present[k] > 0.0) {
            eps[k] = filled[at] - predicted;
        } else {
            filled[at] = predicted;
        }
    }
    filled_ = filled.tail(std::min(p, filled.size()));
    return eps;
}

Eigen::VectorXd innovations(const autoregression& model, const gapped_series& segment) {
    const Eigen::Index known = std::max(segment.value.size() - model.order(), Eigen::Index{0});
    return innovation_filter(model).next(segment).tail(known);
}

Eigen::MatrixXd innovation_responses(const autoregression& model, const Eigen::MatrixXd& X, Eigen::Index tail) {
    // x'e = sum_k x_k sum_i psi_i eps_{k-i} = sum_m eps_m z_m with z_m = sum_{k>=m} psi_{k-m} x_k: the columns filtered
    // by the model backward in time, from the last row to the innovations before the first one.
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(X.rows() + tail, X.cols());
    Z.bottomRows(X.rows()) = X;
    for (Eigen::Index c = 0; c < Z.cols(); ++c) {
        if (!X.col(c).isZero(0.0)) {
            filter_backward(model.a, Z.col(c));
        }
    }
    return Z;
}

Eigen::MatrixXd covariance_times(const autoregression& model, const Eigen::MatrixXd& Z, Eigen::Index n) {
    // Gamma = innovation Psi Psi' with Psi the responses to an innovation: Z = Psi' X, filtered forward in time it is
    // Psi Psi' X.
    Eigen::MatrixXd series = Z;
    for (Eigen::Index c = 0; c < series.cols(); ++c) {
        if (!Z.col(c).isZero(0.0)) {
            filter_forward(model.a, series.col(c));
        }
    }
    return model.innovation * series.bottomRows(n);
}

Eigen::VectorXd lagged_products(const Eigen::MatrixXd& X, Eigen::Index lags, Eigen::Index first, Eigen::Index count) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(lags + 1);
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
        const auto x = X.col(c);
        if (x.isZero(0.0)) {
            continue;
        }
        for (Eigen::Index l = 0; l <= std::min(lags, X.rows() - 1 - first); ++l) {
            const Eigen::Index pairs = std::min(count, X.rows() - l - first);
            sum[l] += x.segment(first, pairs).dot(x.segment(first + l, pairs));
        }
    }
    return sum;
}

Eigen::VectorXd lagged_products(const Eigen::MatrixXd& X, Eigen::Index lags) {
    return lagged_products(X, lags, 0, X.rows());
}

}  // namespace idim
