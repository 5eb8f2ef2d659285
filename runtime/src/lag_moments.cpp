#include "lag_moments.hpp"

#include <algorithm>

namespace idim {

namespace {

constexpr double shortest_share = 0.25;  // of the samples, for a reflection coefficient to be taken from them

}  // namespace

lag_moments::lag_moments(Eigen::Index lags)
    : lags_(lags), pairs_(Eigen::VectorXd::Zero(lags + 1)), count_(static_cast<std::size_t>(lags + 1), 0) {
    for (Eigen::Index q = 0; q <= lags; ++q) {
        windows_.push_back(matrix::Zero(q + 1, q + 1));
    }
}

void lag_moments::begin_segment() {
    history_ = {};
    run_ = 0;
}

void lag_moments::add(const gapped_series& piece) {
    const Eigen::Index before = history_.value.size();
    const Eigen::Index n = before + piece.value.size();
    Eigen::VectorXd value(n);
    Eigen::VectorXd present(n);
    value << history_.value, piece.value;
    present << history_.present, piece.present;
    const vector exact = value.cast<long double>();
    add_pairs(present, before);
    for (Eigen::Index k = before; k < n;) {
        if (!(present[k] > 0.0)) {
            run_ = 0;
            ++k;
            continue;
        }
        if (run_ < lags_) {
            const auto q = static_cast<std::size_t>(run_++);
            const vector window = exact.segment(k - run_ + 1, run_).reverse();
            windows_[q] += window * window.transpose();
            ++count_[q];
            power_ += exact[k] * exact[k];
            ++samples_;
            ++k;
            continue;
        }
        Eigen::Index end = k;
        while (end < n && present[end] > 0.0) {
            ++end;
        }
        add_full_windows(exact, k, end);
        run_ = lags_;  // or more, which is the same
        k = end;
    }
    keep_history(value, present);
}

void lag_moments::add_pairs(const Eigen::VectorXd& present, Eigen::Index first) {
    for (Eigen::Index lag = 0; lag <= lags_; ++lag) {
        const Eigen::Index from = std::max(first, lag);
        if (const Eigen::Index size = present.size() - from; size > 0) {
            pairs_[lag] += present.segment(from, size).dot(present.segment(from - lag, size));
        }
    }
}

/// Windows of lags + 1 samples that end at begin..end-1. Along the diagonals of their sum only the two ends differ.
void lag_moments::add_full_windows(const vector& value, Eigen::Index begin, Eigen::Index end) {
    matrix& sum = windows_.back();
    matrix added(lags_ + 1, lags_ + 1);
    const Eigen::Index size = end - begin;
    for (Eigen::Index j = 0; j <= lags_; ++j) {
        added(0, j) = value.segment(begin, size).dot(value.segment(begin - j, size));
    }
    for (Eigen::Index i = 1; i <= lags_; ++i) {
        added(i, 0) = added(0, i);
        for (Eigen::Index j = 1; j <= lags_; ++j) {
            added(i, j) = added(i - 1, j - 1) + value[begin - i] * value[begin - j] - value[end - i] * value[end - j];
        }
    }
    sum += added;
    count_.back() += size;
    samples_ += size;
    power_ += added(0, 0);
}

void lag_moments::keep_history(const Eigen::VectorXd& value, const Eigen::VectorXd& present) {
    const Eigen::Index kept = std::min(lags_, value.size());
    history_ = {value.tail(kept), present.tail(kept)};
}

Eigen::VectorXd lag_moments::autocovariance() const {
    Eigen::VectorXd gamma = Eigen::VectorXd::Zero(lags_ + 1);
    if (samples_ == 0) {
        return gamma;
    }
    const double least = shortest_share * static_cast<double>(samples_);
    // Sums over windows of p + 1 samples: those of longer ones, and of shorter ones at the beginnings of runs.
    std::vector<matrix> sums(windows_.begin(), windows_.end());
    std::vector<double> count(count_.begin(), count_.end());
    for (Eigen::Index p = lags_ - 1; p >= 0; --p) {
        sums[p] += sums[p + 1].topLeftCorner(p + 1, p + 1);
        count[p] += count[p + 1];
    }
    vector exact = vector::Zero(lags_ + 1);
    exact[0] = power_ / static_cast<long double>(samples_);
    vector a(0);
    long double v = exact[0];
    for (Eigen::Index p = 1; p <= lags_; ++p) {
        vector forward(p + 1);
        forward << 1.0L, -a, 0.0L;
        const vector backward = forward.reverse();
        const vector by_forward = sums[p] * forward;
        const long double power = forward.dot(by_forward) + backward.dot(sums[p] * backward);
        const bool known = power > 0.0L && count[p] >= least;
        const long double reflection = known ? std::clamp(2.0L * backward.dot(by_forward) / power, -1.0L, 1.0L) : 0.0L;
        exact[p] = a.dot(exact.segment(1, p - 1).reverse()) + reflection * v;
        a = raised(a, reflection);
        v *= 1.0L - reflection * reflection;
    }
    return exact.cast<double>();
}

}  // namespace idim
