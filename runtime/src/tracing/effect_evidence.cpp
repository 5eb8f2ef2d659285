#include "effect_evidence.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "idim/autocorrelation.hpp"

namespace idim {

namespace {

constexpr double shortest_block = 5.0;     ///< rows
constexpr double memories_in_block = 4.0;  ///< correlation lengths in a block
constexpr Eigen::Index fewest_blocks = 10;

/// Rows at their places in time, zero between.
Eigen::VectorXd on_grid(const traced_log& log, int joint, const Eigen::VectorXd& values) {
    Eigen::VectorXd spread = Eigen::VectorXd::Zero(log.rows.t.size());
    spread(log.rows.kept[static_cast<std::size_t>(joint)]) = values;
    return spread;
}

/// Block of each sample: longer than the residual's correlation, but at least fewest_blocks of them.
Eigen::Index block_length(Eigen::Index samples, double correlation) {
    const auto wanted = static_cast<Eigen::Index>(std::ceil(std::max(shortest_block, memories_in_block * correlation)));
    return std::max<Eigen::Index>(1, std::min(wanted, samples / fewest_blocks));
}

Eigen::VectorXd block_sums(const Eigen::VectorXd& series, Eigen::Index length) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(std::max<Eigen::Index>(1, series.size() / length));
    for (Eigen::Index k = 0; k < series.size(); ++k) {
        sums[std::min(sums.size() - 1, k / length)] += series[k];
    }
    return sums;
}

/// Decrease of the weighted squared residual from `before` to `after` in one log, and its deviation. With d the change
/// of the residual, the decrease is sum (2 before d - d^2), that is (2 beta - 1) sum d^2 with beta the slope of
/// `before` on d: 1 for an effect that is there, 0 for one that is not. Its deviation is that of the slope, from sums
/// over blocks of what the slope leaves; blocks in which much is gained do not make it uncertain.
struct loss_decrease {
    double value = 0.0;
    double variance = 0.0;
};

loss_decrease decrease(const trace_fit& fit, std::size_t l, const std::vector<Eigen::VectorXd>& before,
                       const std::vector<Eigen::VectorXd>& after, double correlation, bool moving_only) {
    const traced_log& log = fit.logs()[l];
    Eigen::VectorXd products = Eigen::VectorXd::Zero(log.rows.t.size());
    Eigen::VectorXd squares = products;
    for (std::size_t j = 0; j < before.size(); ++j) {
        Eigen::ArrayXd weight = fit.weight()[l][j].array().square();
        if (moving_only) {
            weight = log.reversal[j].select(0.0, weight);
        }
        const Eigen::ArrayXd change = before[j].array() - after[j].array();
        const int joint = static_cast<int>(j);
        products += on_grid(log, joint, weight * before[j].array() * change);
        squares += on_grid(log, joint, weight * change.square());
    }
    const Eigen::Index length = block_length(products.size(), correlation);
    const Eigen::VectorXd p = block_sums(products, length);
    const Eigen::VectorXd s = block_sums(squares, length);
    const double slope = s.sum() > 0.0 ? p.sum() / s.sum() : 0.0;
    const auto blocks = static_cast<double>(p.size());
    return {2.0 * p.sum() - s.sum(), 4.0 * (p - slope * s).squaredNorm() * blocks / std::max(1.0, blocks - 1.0)};
}

double tail_of_f(double f, double m, double freedom) {
    if (!(f > 0.0)) {
        return 1.0;
    }
    const boost::math::fisher_f distribution(m, freedom);
    return boost::math::cdf(boost::math::complement(distribution, f));
}

double share_of_parameters(const trace_fit& fit, double rows) {
    double all = 0.0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        for (const Eigen::VectorXd& residual : fit.residual()[l]) {
            all += fit.logs()[l].held_back ? 0.0 : static_cast<double>(residual.size());
        }
    }
    return fit.parameters() * rows / all;
}

/// Share of the weighted squared residual of one joint that is gone from the logs held back.
double explained_at(const trace_fit& fit, const log_series& left, int joint) {
    const auto j = static_cast<std::size_t>(joint);
    double before = 0.0;
    double after = 0.0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        if (fit.logs()[l].held_back) {
            before += fit.residual()[l][j].cwiseProduct(fit.weight()[l][j]).squaredNorm();
            after += left[l][j].cwiseProduct(fit.weight()[l][j]).squaredNorm();
        }
    }
    return before > 0.0 ? 1.0 - after / before : 0.0;
}

bool within_bounds(const effect_candidate& candidate, const Eigen::VectorXd& coefficient) {
    for (Eigen::Index c = 0; c < coefficient.size(); ++c) {
        const std::size_t which = static_cast<std::size_t>(c) % candidate.linear.size();
        if (coefficient[c] < candidate.linear[which].min || coefficient[c] > candidate.linear[which].max) {
            return false;
        }
    }
    return true;
}

/// Values chosen beside the linear coefficients: the shape, and how its motion begins in every fitted log.
double searched_values(const trace_fit& fit, const effect_candidate& candidate) {
    const auto fitted =
        std::count_if(fit.logs().begin(), fit.logs().end(), [](const traced_log& log) { return !log.held_back; });
    return static_cast<double>(candidate.shape.size()) + static_cast<double>(candidate.states * fitted);
}

}  // namespace

row_count count_rows(const trace_fit& fit, const std::vector<int>& touched, const log_series& residual) {
    row_count sums;
    for (const int j : touched) {
        double rows = 0.0;
        for (std::size_t l = 0; l < fit.logs().size(); ++l) {
            if (!fit.logs()[l].held_back) {
                const auto joint = static_cast<std::size_t>(j);
                sums.squared += residual[l][joint].cwiseProduct(fit.weight()[l][joint]).squaredNorm();
                rows += static_cast<double>(residual[l][joint].size());
            }
        }
        sums.rows += rows;
        sums.effective += rows / correlation_length(fit, residual, j);
    }
    sums.parameters = share_of_parameters(fit, sums.rows);
    return sums;
}

f_test partial_f(const row_count& rows, double gain, double m) {
    f_test test;
    const double length = rows.length();
    test.freedom = std::max(1.0, rows.effective - rows.parameters / length - m);
    const double variance = rows.squared / std::max(1.0, rows.rows - rows.parameters);
    test.statistic = gain / (m * length * std::max(variance, 1e-300));
    test.p_value = tail_of_f(test.statistic, m, test.freedom);
    return test;
}

double effect_evidence::z_all() const {
    double sum = 0.0;
    double variance = 0.0;
    for (const held_back_gain& log : held_back) {
        sum += log.all;
        variance += log.all_deviation * log.all_deviation;
    }
    return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

double effect_evidence::z_moving() const {
    double sum = 0.0;
    double variance = 0.0;
    for (const held_back_gain& log : held_back) {
        sum += log.moving;
        variance += log.moving_deviation * log.moving_deviation;
    }
    return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

double corrected(double p_value, double tests) {
    return -std::expm1(tests * std::log1p(-std::min(p_value, 1.0 - 1e-16)));
}

double correlation_length(const trace_fit& fit, const log_series& residual, int joint) {
    std::vector<gapped_series> segments;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        const traced_log& log = fit.logs()[l];
        if (!log.held_back && residual[l][static_cast<std::size_t>(joint)].size() > 0) {
            const auto j = static_cast<std::size_t>(joint);
            const Eigen::VectorXd weighted = residual[l][j].cwiseProduct(fit.weight()[l][j]);
            segments.push_back(
                {on_grid(log, joint, weighted), on_grid(log, joint, Eigen::VectorXd::Ones(weighted.size()))});
        }
    }
    const Eigen::Index samples = samples_of(segments);
    if (samples < 8) {
        return 1.0;
    }
    const autoregression model = fit_autoregression(autocovariance(segments, highest_order(segments)), samples);
    return model.correlation_length(samples / 4);
}

effect_evidence test_on_fitted(const trace_fit& fit, const effect_term& term, bool quick) {
    const effect_candidate& candidate = *term.candidate;
    const projected_columns columns = fit.project(candidate, term.shape, quick);
    effect_evidence evidence;
    evidence.term = term;
    evidence.coefficient = columns.coefficient;
    evidence.gain = columns.gain;
    evidence.within_span = columns.rank == 0 && columns.scale.maxCoeff() > 0.0;
    if (columns.rank == 0 || !(columns.gain > 0.0) || !within_bounds(candidate, columns.coefficient)) {
        evidence.gain = 0.0;
        return evidence;
    }
    log_series left = fit.residual();
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        for (std::size_t i = 0; i < columns.touched.size() && !fit.logs()[l].held_back; ++i) {
            const auto joint = static_cast<std::size_t>(columns.touched[i]);
            const auto m = static_cast<Eigen::Index>(candidate.linear.size());
            const Eigen::Index place = candidate.per_log ? m * static_cast<Eigen::Index>(l) : 0;
            const Eigen::VectorXd added =
                columns.weighted[l][i] * columns.coefficient.segment(place, m) -
                fit.weight()[l][joint].cwiseProduct(fit.columns(l, columns.touched[i]) *
                                                    fit.basis_times(columns.on_basis * columns.coefficient));
            left[l][joint] -= added.cwiseQuotient(fit.weight()[l][joint]);
        }
    }
    const row_count after = count_rows(fit, candidate.touched, left);
    const f_test test = partial_f(after, columns.gain, columns.rank + searched_values(fit, candidate));
    evidence.correlation_length = after.length();
    evidence.freedom = test.freedom;
    evidence.f_statistic = test.statistic;
    evidence.p_value = test.p_value;
    return evidence;
}

log_series residual_with(const trace_fit& fit, const effect_evidence& evidence) {
    const effect_candidate& candidate = *evidence.term.candidate;
    const projected_columns columns = fit.project(candidate, evidence.term.shape, false);
    log_series left;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        left.push_back(fit.residual_with(candidate, evidence.term.shape, columns, l));
    }
    return left;
}

void test_on_held_back(const trace_fit& fit, effect_evidence& evidence) {
    const effect_candidate& candidate = *evidence.term.candidate;
    const log_series left = residual_with(fit, evidence);
    double held_back = 0.0;
    evidence.held_back.clear();
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        if (!fit.logs()[l].held_back) {
            continue;
        }
        const double length = evidence.correlation_length;
        const loss_decrease all = decrease(fit, l, fit.residual()[l], left[l], length, false);
        const loss_decrease moving = decrease(fit, l, fit.residual()[l], left[l], length, true);
        evidence.held_back.push_back({all.value, std::sqrt(all.variance), moving.value, std::sqrt(moving.variance)});
        held_back += all.value;
    }
    evidence.explained_fraction = -1.0;
    for (const int j : candidate.touched) {
        evidence.explained_fraction = std::max(evidence.explained_fraction, explained_at(fit, left, j));
    }
    const double price = (static_cast<double>(candidate.linear.size()) + searched_values(fit, candidate)) *
                         std::log(std::max(2.0, evidence.freedom));
    evidence.score = evidence.gain + held_back - price * evidence.correlation_length;
}

double loss_difference(const trace_fit& fit, const log_series& first, const log_series& second,
                       double correlation_length, bool held_back_only) {
    double value = 0.0;
    double variance = 0.0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        if (held_back_only && !fit.logs()[l].held_back) {
            continue;
        }
        const loss_decrease sum = decrease(fit, l, first[l], second[l], correlation_length, false);
        value += sum.value;
        variance += sum.variance;
    }
    return variance > 0.0 ? value / std::sqrt(variance) : 0.0;
}

}  // namespace idim
