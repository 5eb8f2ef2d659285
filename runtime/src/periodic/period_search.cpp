#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "idim/periodic.hpp"

namespace idim {

namespace {

constexpr double largest_mismatch = 0.05;   // of the motion: beyond it periods do not repeat
constexpr double smallest_mismatch = 1e-3;  // of the motion: a transient that matters no more
constexpr double transient_factor = 3.0;    // times the median mismatch
constexpr double as_good = 2.0;             // times the smallest mismatch
constexpr Eigen::Index windows_per_period = 10;
constexpr Eigen::Index shortest_period = 16;  // [samples]
constexpr std::size_t most_candidates = 24;

/// Positions of the joints that move, mean 0 and mean square 1.
Eigen::MatrixXd normalised_motion(const Eigen::MatrixXd& q) {
    const Eigen::VectorXd range = q.colwise().maxCoeff() - q.colwise().minCoeff();
    std::vector<Eigen::Index> moving;
    for (Eigen::Index j = 0; j < q.cols(); ++j) {
        if (range[j] > held_range * range.maxCoeff()) {
            moving.push_back(j);
        }
    }
    Eigen::MatrixXd X = q(Eigen::all, moving);
    X.rowwise() -= X.colwise().mean().eval();
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
        X.col(j) /= std::sqrt(X.col(j).squaredNorm() / static_cast<double>(X.rows()));
    }
    return X;
}

/// sum_k x_k x_{k+L} over all columns at lags 0..lags, by the fast Fourier transform.
Eigen::VectorXd lagged_sums(const Eigen::MatrixXd& X, Eigen::Index lags) {
    Eigen::Index length = 1;
    while (length < X.rows() + lags + 1) {
        length *= 2;
    }
    Eigen::FFT<double> fft;
    Eigen::VectorXcd transform;
    Eigen::VectorXcd power = Eigen::VectorXcd::Zero(length);
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
        Eigen::VectorXd padded = Eigen::VectorXd::Zero(length);
        padded.head(X.rows()) = X.col(j);
        fft.fwd(transform, padded);
        power += transform.cwiseAbs2();
    }
    Eigen::VectorXd sums;
    fft.inv(sums, power);
    return sums.head(lags + 1);
}

/// |x_{k+L} - x_k|^2 over |x_k|^2 + |x_{k+L}|^2 at lags 0..lags: 0 for a period, about 1 for what has nothing to do
/// with each other.
Eigen::VectorXd lag_distance(const Eigen::MatrixXd& X, Eigen::Index lags) {
    const Eigen::VectorXd products = lagged_sums(X, lags);
    const Eigen::VectorXd power = X.rowwise().squaredNorm();
    Eigen::VectorXd distance(lags + 1);
    double energy = 2.0 * power.sum();
    for (Eigen::Index lag = 0; lag <= lags; ++lag) {
        distance[lag] = energy > 0.0 ? (energy - 2.0 * products[lag]) / energy : 1.0;
        energy -= power[lag] + power[X.rows() - 1 - lag];
    }
    return distance;
}

/// Local minima beyond the main lobe around lag 0, the lowest ones, ascending in the lag.
std::vector<Eigen::Index> candidates_of(const Eigen::VectorXd& distance) {
    std::vector<Eigen::Index> lags;
    Eigen::Index lag = 1;
    while (lag < distance.size() && distance[lag] < 0.25) {
        ++lag;
    }
    for (lag = std::max(lag, shortest_period); lag + 1 < distance.size(); ++lag) {
        if (distance[lag] <= distance[lag - 1] && distance[lag] < distance[lag + 1]) {
            lags.push_back(lag);
        }
    }
    std::sort(lags.begin(), lags.end(),
              [&](Eigen::Index a, Eigen::Index b) { return std::pair(distance[a], a) < std::pair(distance[b], b); });
    lags.resize(std::min(lags.size(), most_candidates));
    std::sort(lags.begin(), lags.end());
    return lags;
}

/// Mismatch of two successive periods over windows of a tenth of one, as a part of the motion.
std::vector<double> window_mismatch(const Eigen::MatrixXd& X, Eigen::Index lag) {
    const Eigen::Index width = std::max<Eigen::Index>(1, lag / windows_per_period);
    std::vector<double> mismatch;
    for (Eigen::Index k = 0; k + width + lag <= X.rows(); k += width) {
        const double square = (X.middleRows(k + lag, width) - X.middleRows(k, width)).squaredNorm();
        mismatch.push_back(std::sqrt(square / static_cast<double>(2 * width * X.cols())));
    }
    return mismatch;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double median_mismatch(const Eigen::MatrixXd& X, Eigen::Index lag) {
    return median(window_mismatch(X, lag));
}

/// The lag at the foot of the slope of the median mismatch on which `lag` stands: a transient or a rest tilts the
/// minimum of lag_distance by some samples.
Eigen::Index refined(const Eigen::MatrixXd& X, Eigen::Index lag, Eigen::Index most) {
    double least = median_mismatch(X, lag);
    for (const Eigen::Index step : {-1, 1}) {
        for (Eigen::Index near = lag + step; near >= shortest_period && near <= most; near += step) {
            const double here = median_mismatch(X, near);
            if (here >= least) {
                break;
            }
            least = here;
            lag = near;
        }
    }
    return lag;
}

/// The shortest lag that repeats as well as the best one, if any repeats.
std::optional<Eigen::Index> best_lag(const Eigen::MatrixXd& X, Eigen::Index most) {
    std::vector<Eigen::Index> lags;
    std::vector<double> mismatch;
    for (const Eigen::Index lag : candidates_of(lag_distance(X, most))) {
        lags.push_back(refined(X, lag, most));
        mismatch.push_back(median_mismatch(X, lags.back()));
    }
    if (lags.empty()) {
        return std::nullopt;
    }
    const double least = *std::min_element(mismatch.begin(), mismatch.end());
    for (std::size_t i = 0; i < lags.size(); ++i) {
        if (mismatch[i] <= std::max(as_good * least, smallest_mismatch) && mismatch[i] <= largest_mismatch) {
            return lags[i];
        }
    }
    return std::nullopt;
}

/// Longest run of windows whose mismatch stays within the limit: [first, end).
std::pair<std::size_t, std::size_t> longest_run(const std::vector<double>& mismatch, double limit) {
    std::pair<std::size_t, std::size_t> longest{0, 0};
    for (std::size_t k = 0; k < mismatch.size();) {
        std::size_t end = k;
        while (end < mismatch.size() && mismatch[end] <= limit) {
            ++end;
        }
        if (end - k > longest.second - longest.first) {
            longest = {k, end};
        }
        k = end + 1;
    }
    return longest;
}

/// The whole periods of a log with this period.
period_search part_with(const Eigen::MatrixXd& X, Eigen::Index period, double rate) {
    const double seconds = static_cast<double>(period) / rate;
    if (X.rows() < 2 * period) {
        return {{},
                fmt::format("fewer than two periods: {:.6g} s of motion with a period of {:.6g} s, expected at least "
                            "twice that",
                            static_cast<double>(X.rows()) / rate, seconds)};
    }
    const std::vector<double> mismatch = window_mismatch(X, period);
    const double typical = median(mismatch);
    if (typical > largest_mismatch) {
        return {{},
                fmt::format("the periods do not repeat: positions {:.6g} s apart differ by {:.3g} % of the motion, "
                            "expected at most {:.3g} %",
                            seconds, 100.0 * typical, 100.0 * largest_mismatch)};
    }
    const auto [from, to] = longest_run(mismatch, std::max(transient_factor * typical, smallest_mismatch));
    const auto width = static_cast<std::size_t>(std::max<Eigen::Index>(1, period / windows_per_period));
    const auto begin = static_cast<Eigen::Index>(from * width);
    // The last window stands for the rest of the log, too short for one of its own.
    const Eigen::Index end = to == mismatch.size() ? X.rows() : static_cast<Eigen::Index>(to * width) + period;
    periodic_part part;
    part.period = period;
    part.periods = (end - begin) / period;
    if (part.periods < 2) {
        return {{},
                fmt::format("fewer than two periods: with a period of {:.6g} s the motion repeats over {:.6g} s only, "
                            "expected at least twice the period",
                            seconds, static_cast<double>(end - begin) / rate)};
    }
    part.first = end - part.periods * period;
    part.after = X.rows() - end;
    part.mismatch = typical;
    return {part, {}};
}

}  // namespace

period_search find_period(const filtered_samples& samples, std::optional<double> period) {
    const Eigen::MatrixXd X = normalised_motion(samples.q);
    if (X.cols() == 0) {
        return {{}, "no joint moves, so that nothing repeats"};
    }
    if (period) {
        const double length = *period * samples.rate;
        if (!(length >= static_cast<double>(shortest_period))) {
            return {{},
                    fmt::format("a period of {:.6g} s is shorter than {} samples at {:.6g} Hz", *period,
                                shortest_period, samples.rate)};
        }
        const double drift = std::abs(length - std::round(length)) * static_cast<double>(X.rows()) / length;
        if (drift > 0.5 && length < static_cast<double>(X.rows())) {
            return {{},
                    fmt::format("a period of {:.9g} s is {:.3f} samples at {:.6g} Hz, expected a whole number", *period,
                                length, samples.rate)};
        }
        const double most = 2.0 * static_cast<double>(X.rows());  // longer ones are too long anyway
        return part_with(X, static_cast<Eigen::Index>(std::round(std::min(length, most))), samples.rate);
    }
    const Eigen::Index half = X.rows() / 2;
    const std::optional<Eigen::Index> lag = half > shortest_period ? best_lag(X, half) : std::nullopt;
    return lag ? part_with(X, *lag, samples.rate)
               : period_search{{},
                               fmt::format("nothing repeats: no lag up to half of {:.6g} s finds the positions again",
                                           static_cast<double>(X.rows()) / samples.rate)};
}

}  // namespace idim
