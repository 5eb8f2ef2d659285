#include "idim/autocorrelation.hpp"

#include <algorithm>
#include <cmath>

namespace idim {

namespace {

constexpr double forgotten = 1e-4;
constexpr double shortest_share = 0.25;  // of the samples, for a reflection coefficient to be taken from them

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

/// Coefficients of one order more, by Levinson's recursion.
Eigen::VectorXd raised(const Eigen::VectorXd& a, double reflection) {
    Eigen::VectorXd next(a.size() + 1);
    next << a - reflection * a.reverse(), reflection;
    return next;
}

/// Prediction errors of one segment at the present order of Burg's recursion.
struct lattice {
    Eigen::VectorXd forward;
    Eigen::VectorXd backward;
    Eigen::VectorXi run;  ///< samples without a gap that end at each
};

lattice start_lattice(const gapped_series& segment) {
    lattice errors{segment.value, segment.value, Eigen::VectorXi::Zero(segment.value.size())};
    for (Eigen::Index k = 0; k < errors.run.size(); ++k) {
        errors.run[k] = segment.present[k] > 0.0 ? (k > 0 ? errors.run[k - 1] : 0) + 1 : 0;
    }
    return errors;
}

/// The reflection coefficient of order p, applied to the errors; 0 if fewer than `least` samples have p before them.
double reflect(std::vector<lattice>& segments, Eigen::Index p, double least) {
    double products = 0.0;
    double power = 0.0;
    double count = 0.0;
    for (const lattice& errors : segments) {
        for (Eigen::Index k = p; k < errors.run.size(); ++k) {
            if (errors.run[k] > p) {
                products += errors.forward[k] * errors.backward[k - 1];
                power += errors.forward[k] * errors.forward[k] + errors.backward[k - 1] * errors.backward[k - 1];
                count += 1.0;
            }
        }
    }
    const double reflection = power > 0.0 && count >= least ? 2.0 * products / power : 0.0;
    for (lattice& errors : segments) {
        for (Eigen::Index k = errors.run.size() - 1; k >= p; --k) {
            const double forward = errors.forward[k];
            errors.forward[k] -= reflection * errors.backward[k - 1];
            errors.backward[k] = errors.backward[k - 1] - reflection * forward;
        }
    }
    return reflection;
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

Eigen::Index autoregression::memory(Eigen::Index limit) const {
    if (order() == 0) {
        return 0;
    }
    Eigen::VectorXd response = Eigen::VectorXd::Zero(limit + order() + 1);
    response[0] = 1.0;
    Eigen::Index quiet = 0;
    for (Eigen::Index m = 1; m < response.size(); ++m) {
        const Eigen::Index past = std::min(order(), m);
        response[m] = a.head(past).dot(response.segment(m - past, past).reverse());
        quiet = std::abs(response[m]) < forgotten ? quiet + 1 : 0;
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
    const auto samples = static_cast<double>(samples_of(segments));
    Eigen::VectorXd gamma = Eigen::VectorXd::Zero(lags + 1);
    std::vector<lattice> errors;
    for (const gapped_series& segment : segments) {
        gamma[0] += segment.value.squaredNorm() / samples;
        errors.push_back(start_lattice(segment));
    }
    Eigen::VectorXd a(0);
    double v = gamma[0];
    for (Eigen::Index p = 1; p <= lags; ++p) {
        const double reflection = reflect(errors, p, shortest_share * samples);
        gamma[p] = a.dot(gamma.segment(1, p - 1).reverse()) + reflection * v;
        a = raised(a, reflection);
        v *= 1.0 - reflection * reflection;
    }
    return samples > 0.0 ? gamma : Eigen::VectorXd::Zero(lags + 1);
}

Eigen::VectorXd lagged_pairs(const std::vector<gapped_series>& segments, Eigen::Index lags) {
    Eigen::VectorXd count = Eigen::VectorXd::Zero(lags + 1);
    for (const gapped_series& segment : segments) {
        count += lagged_products(segment.present, lags);
    }
    return count;
}

Eigen::Index highest_order(const std::vector<gapped_series>& segments) {
    const auto samples = static_cast<double>(samples_of(segments));
    if (samples < 1.0) {
        return 0;
    }
    const double mean_length = samples / static_cast<double>(segments.size());
    return static_cast<Eigen::Index>(std::min(10.0 * std::log10(samples), mean_length / 4.0));
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

Eigen::VectorXd innovations(const autoregression& model, const gapped_series& segment) {
    const Eigen::Index p = model.order();
    Eigen::VectorXd filled = segment.value;
    Eigen::VectorXd eps = Eigen::VectorXd::Zero(std::max(filled.size() - p, Eigen::Index{0}));
    for (Eigen::Index k = p; k < filled.size(); ++k) {
        const double predicted = model.a.dot(filled.segment(k - p, p).reverse());
        if (segment.present[k] > 0.0) {
            eps[k - p] = filled[k] - predicted;
        } else {
            filled[k] = predicted;
        }
    }
    return eps;
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

Eigen::VectorXd lagged_products(const Eigen::MatrixXd& X, Eigen::Index lags) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(lags + 1);
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
        const auto x = X.col(c);
        if (x.isZero(0.0)) {
            continue;
        }
        for (Eigen::Index l = 0; l <= std::min(lags, X.rows() - 1); ++l) {
            sum[l] += x.head(X.rows() - l).dot(x.tail(X.rows() - l));
        }
    }
    return sum;
}

}  // namespace idim
