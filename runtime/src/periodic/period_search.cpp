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
constexpr Eigen::Index samples_at_once = Eigen::Index{1} << 15;
constexpr Eigen::Index samples_searched = Eigen::Index{1} << 20;

/// Positions of the joints that move, mean 0 and mean square 1 over the log.
class normalised_motion {
  public:
    explicit normalised_motion(const motion_source& motion);

    Eigen::Index samples() const { return motion_.samples(); }
    Eigen::Index joints() const { return static_cast<Eigen::Index>(moving_.size()); }
    /// Samples first..first+count-1 [count x joints].
    Eigen::MatrixXd rows(Eigen::Index first, Eigen::Index count) const {
        const Eigen::MatrixXd q = motion_.part(first, count).q(Eigen::all, moving_);
        return (q.rowwise() - mean_) * scale_.asDiagonal();
    }

  private:
    const motion_source& motion_;
    std::vector<Eigen::Index> moving_;
    Eigen::RowVectorXd mean_;
    Eigen::VectorXd scale_;
};

/// Calls `use` with successive positions of a log.
template <typename Use>
void for_positions(const motion_source& motion, const Use& use) {
    for (Eigen::Index first = 0; first < motion.samples(); first += samples_at_once) {
        use(motion.part(first, std::min(samples_at_once, motion.samples() - first)).q);
    }
}

normalised_motion::normalised_motion(const motion_source& motion) : motion_(motion) {
    Eigen::RowVectorXd lowest = motion.part(0, 1).q.row(0);
    Eigen::RowVectorXd highest = lowest;
    Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(lowest.size());
    Eigen::RowVectorXd square = mean;
    const auto n = static_cast<double>(motion.samples());
    for_positions(motion, [&](const Eigen::MatrixXd& q) {
        lowest = lowest.cwiseMin(q.colwise().minCoeff());
        highest = highest.cwiseMax(q.colwise().maxCoeff());
        mean += q.colwise().sum() / n;
    });
    for_positions(motion,
                  [&](const Eigen::MatrixXd& q) { square += (q.rowwise() - mean).colwise().squaredNorm() / n; });
    const Eigen::RowVectorXd range = highest - lowest;
    for (Eigen::Index j = 0; j < range.size(); ++j) {
        if (range[j] > held_range * range.maxCoeff()) {
            moving_.push_back(j);
        }
    }
    mean_ = mean(moving_);
    scale_ = square(moving_).cwiseSqrt().cwiseInverse();
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

/// Samples of one window.
Eigen::Index window_width(Eigen::Index lag) {
    return std::max<Eigen::Index>(1, lag / windows_per_period);
}

/// Appends the mismatch of samples and those one period later over windows of so many.
void append_mismatch(const Eigen::Ref<const Eigen::MatrixXd>& X, const Eigen::Ref<const Eigen::MatrixXd>& later,
                     Eigen::Index width, std::vector<double>& mismatch) {
    for (Eigen::Index k = 0; k + width <= X.rows(); k += width) {
        const double square = (later.middleRows(k, width) - X.middleRows(k, width)).squaredNorm();
        mismatch.push_back(std::sqrt(square / static_cast<double>(2 * width * X.cols())));
    }
}

/// Mismatch of two successive periods over windows of a tenth of one, as a part of the motion.
std::vector<double> window_mismatch(const Eigen::MatrixXd& X, Eigen::Index lag) {
    std::vector<double> mismatch;
    const Eigen::Index pairs = std::max(X.rows() - lag, Eigen::Index{0});
    append_mismatch(X.topRows(pairs), X.bottomRows(pairs), window_width(lag), mismatch);
    return mismatch;
}

/// The same over a whole log.
std::vector<double> window_mismatch(const normalised_motion& X, Eigen::Index lag) {
    const Eigen::Index width = window_width(lag);
    const Eigen::Index pairs = X.samples() - lag;
    const Eigen::Index at_once = std::max(samples_at_once / width, Eigen::Index{1}) * width;
    std::vector<double> mismatch;
    for (Eigen::Index first = 0; first < pairs; first += at_once) {
        const Eigen::Index count = std::min(at_once, pairs - first);
        append_mismatch(X.rows(first, count), X.rows(first + lag, count), width, mismatch);
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
period_search part_with(const normalised_motion& X, Eigen::Index period, double rate) {
    const double seconds = static_cast<double>(period) / rate;
    if (X.samples() < 2 * period) {
        return {{},
                fmt::format("fewer than two periods: {:.6g} s of motion with a period of {:.6g} s, expected at least "
                            "twice that",
                            static_cast<double>(X.samples()) / rate, seconds)};
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
    const auto width = static_cast<std::size_t>(window_width(period));
    const auto begin = static_cast<Eigen::Index>(from * width);
    // The last window stands for the rest of the log, too short for one of its own.
    const Eigen::Index end = to == mismatch.size() ? X.samples() : static_cast<Eigen::Index>(to * width) + period;
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
    part.after = X.samples() - end;
    part.mismatch = typical;
    return {part, {}};
}

}  // namespace

period_search find_period(const motion_source& motion, std::optional<double> period) {
    const normalised_motion X(motion);
    const double rate = motion.rate();
    if (X.joints() == 0) {
        return {{}, "no joint moves, so that nothing repeats"};
    }
    if (period) {
        const double length = *period * rate;
        if (!(length >= static_cast<double>(shortest_period))) {
            return {{},
                    fmt::format("a period of {:.6g} s is shorter than {} samples at {:.6g} Hz", *period,
                                shortest_period, rate)};
        }
        const double drift = std::abs(length - std::round(length)) * static_cast<double>(X.samples()) / length;
        if (drift > 0.5 && length < static_cast<double>(X.samples())) {
            return {{},
                    fmt::format("a period of {:.9g} s is {:.3f} samples at {:.6g} Hz, expected a whole number", *period,
                                length, rate)};
        }
        const double most = 2.0 * static_cast<double>(X.samples());  // longer ones are too long anyway
        return part_with(X, static_cast<Eigen::Index>(std::round(std::min(length, most))), rate);
    }
    const Eigen::Index searched = std::min(X.samples(), samples_searched);
    const Eigen::Index half = searched / 2;
    const std::optional<Eigen::Index> lag = half > shortest_period ? best_lag(X.rows(0, searched), half) : std::nullopt;
    return lag ? part_with(X, *lag, rate)
               : period_search{{},
                               fmt::format("nothing repeats: no lag up to half of {:.6g} s finds the positions again",
                                           static_cast<double>(searched) / rate)};
}

period_search find_period(const filtered_samples& samples, std::optional<double> period) {
    return find_period(resident_motion(samples), period);
}

}  // namespace idim
