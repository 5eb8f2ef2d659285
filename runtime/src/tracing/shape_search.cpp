#include "shape_search.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace idim {

namespace {

constexpr double grid_step = 0.8;  ///< sine of the angle between the columns of neighbours, about
constexpr int most_points = 3000;
constexpr std::size_t peaks = 3;
constexpr int golden_steps = 14;

/// Quick columns of all fitted logs stacked.
Eigen::MatrixXd stacked(const trace_fit& fit, const effect_candidate& candidate, const Eigen::VectorXd& shape) {
    std::vector<Eigen::MatrixXd> parts;
    Eigen::Index rows = 0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        for (const int j : candidate.touched) {
            if (!fit.logs()[l].held_back) {
                parts.push_back(candidate.quick_rows(fit.logs()[l], j, shape));
                rows += parts.back().rows();
            }
        }
    }
    Eigen::MatrixXd all(rows, static_cast<Eigen::Index>(candidate.linear.size()));
    Eigen::Index place = 0;
    for (const Eigen::MatrixXd& part : parts) {
        all.middleRows(place, part.rows()) = part;
        place += part.rows();
    }
    return all;
}

/// Largest sine of the angle per unit of the shape between the spans of the columns at `value` and just beside it.
double turning_rate(const trace_fit& fit, const effect_candidate& candidate, double value, double step) {
    const Eigen::MatrixXd here = stacked(fit, candidate, Eigen::VectorXd::Constant(1, value));
    const Eigen::MatrixXd beside = stacked(fit, candidate, Eigen::VectorXd::Constant(1, value + step));
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(here);
    if (qr.rank() == 0) {
        return 0.0;
    }
    const Eigen::MatrixXd off = beside - here * qr.solve(beside);
    double rate = 0.0;
    for (Eigen::Index c = 0; c < off.cols(); ++c) {
        const double norm = beside.col(c).norm();
        rate = norm > 0.0 ? std::max(rate, off.col(c).norm() / norm / step) : rate;
    }
    return rate;
}

/// Values from low to high, each a step of about the same angle from the one before.
std::vector<double> grid_of(const trace_fit& fit, const effect_candidate& candidate) {
    const shape_bound& bound = candidate.shape.front();
    const double range = bound.high - bound.low;
    std::vector<double> values;
    double value = bound.low;
    while (value < bound.high && static_cast<int>(values.size()) < most_points) {
        values.push_back(value);
        const double probe = std::min(1e-3 * range, 0.01 * std::max(std::abs(value), 1e-3 * range));
        const double rate = turning_rate(fit, candidate, value, probe);
        const double widest = std::max(0.5 * std::abs(value), range / 1000.0);
        value += rate > 0.0 ? std::clamp(grid_step / rate, range / most_points, widest) : widest;
    }
    values.push_back(bound.high);
    return values;
}

struct peak {
    std::size_t place;
    double gain;
};

std::vector<peak> highest_peaks(const std::vector<double>& gains) {
    std::vector<peak> found;
    for (std::size_t k = 0; k < gains.size(); ++k) {
        const bool rises = k == 0 || gains[k] >= gains[k - 1];
        const bool falls = k + 1 == gains.size() || gains[k] > gains[k + 1];
        if (rises && falls && gains[k] > 0.0) {
            found.push_back({k, gains[k]});
        }
    }
    std::sort(found.begin(), found.end(), [](const peak& a, const peak& b) { return a.gain > b.gain; });
    found.resize(std::min(found.size(), peaks));
    return found;
}

effect_evidence at(const trace_fit& fit, const candidate_pointer& candidate, double value, bool quick) {
    return test_on_fitted(fit, {candidate, Eigen::VectorXd::Constant(1, value)}, quick);
}

/// Largest gain between two values by golden section, on exact columns.
effect_evidence golden(const trace_fit& fit, const candidate_pointer& candidate, double low, double high) {
    const double section = 0.5 * (std::sqrt(5.0) - 1.0);
    double a = high - section * (high - low);
    double b = low + section * (high - low);
    const auto gain = [&](double value) {
        const projected_columns columns = fit.project(*candidate, Eigen::VectorXd::Constant(1, value), false);
        return columns.gain;
    };
    double at_a = gain(a);
    double at_b = gain(b);
    for (int step = 0; step < golden_steps; ++step) {
        if (at_a > at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - section * (high - low);
            at_a = gain(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + section * (high - low);
            at_b = gain(b);
        }
    }
    return at(fit, candidate, at_a > at_b ? a : b, false);
}

effect_evidence search_one(const trace_fit& fit, const candidate_pointer& candidate, double promising) {
    const std::vector<double> values = grid_of(fit, *candidate);
    std::vector<double> gains;
    gains.reserve(values.size());
    for (const double value : values) {
        gains.push_back(fit.project(*candidate, Eigen::VectorXd::Constant(1, value), true).gain);
    }
    effect_evidence best;
    best.term = {candidate, Eigen::VectorXd::Constant(1, values.front())};
    for (const peak& top : highest_peaks(gains)) {
        const effect_evidence quick = at(fit, candidate, values[top.place], true);
        if (quick.gain > 0.0 && corrected(quick.p_value, static_cast<double>(values.size())) < promising) {
            const double low = values[top.place == 0 ? 0 : top.place - 1];
            const double high = values[std::min(top.place + 1, values.size() - 1)];
            const effect_evidence exact = golden(fit, candidate, low, high);
            best = exact.gain > best.gain ? exact : best;
        } else {
            best = quick.gain > best.gain && best.p_value > quick.p_value ? quick : best;
        }
    }
    best.shapes_tried = static_cast<int>(values.size());
    return best;
}

}  // namespace

effect_evidence search_shape(const trace_fit& fit, const candidate_pointer& candidate, double promising) {
    if (candidate->shape.empty()) {
        return test_on_fitted(fit, {candidate, Eigen::VectorXd()}, false);
    }
    if (const std::vector<Eigen::VectorXd> starts = candidate->starts(fit); !starts.empty()) {
        effect_evidence best;
        best.term = {candidate, starts.front()};
        for (const Eigen::VectorXd& start : starts) {
            const effect_evidence found = test_on_fitted(fit, {candidate, start}, false);
            best = found.gain > best.gain ? found : best;
        }
        best.shapes_tried = candidate->shapes_tried(fit);
        return best;
    }
    return search_one(fit, candidate, promising);
}

effect_evidence refine_shape(const trace_fit& fit, const effect_term& start, double reach) {
    if (start.candidate->shape.size() != 1) {
        return test_on_fitted(fit, {start.candidate, start.candidate->shape_near(fit, start.shape)}, false);
    }
    const shape_bound& bound = start.candidate->shape.front();
    const double low = std::max(bound.low, start.shape[0] - reach);
    const double high = std::min(bound.high, start.shape[0] + reach);
    const effect_evidence found = golden(fit, start.candidate, low, high);
    const effect_evidence before = test_on_fitted(fit, start, false);
    return found.gain > before.gain ? found : before;
}

}  // namespace idim
