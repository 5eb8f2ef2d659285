#include "term_deviations.hpp"

#include <algorithm>
#include <cmath>

#include "sandwich.hpp"
#include "stacked_qr.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// Where the derivative columns of the shapes of a term stand.
struct shape_columns {
    std::vector<Eigen::Index> first;
    Eigen::Index total = 0;
};

shape_columns places_of(const trace_fit& fit) {
    shape_columns places;
    places.total = fit.all_coefficients().size();
    for (const effect_term& term : fit.terms()) {
        places.first.push_back(places.total);
        places.total += term.shape.size();
    }
    return places;
}

Eigen::VectorXd torque_of(const trace_fit& fit, std::size_t term, std::size_t log, int joint,
                          const Eigen::VectorXd& shape) {
    const effect_candidate& candidate = *fit.terms()[term].candidate;
    const auto m = static_cast<Eigen::Index>(candidate.linear.size());
    const Eigen::Index place = fit.first_column(term) + (candidate.per_log ? m * static_cast<Eigen::Index>(log) : 0);
    return candidate.rows(fit.logs()[log], joint, shape) * fit.all_coefficients().segment(place, m);
}

/// Change of the term's torque with its s-th shape, by central differences: of a hundredth of a per cent for a smooth
/// shape, of a row's time for the ends of an interval.
Eigen::VectorXd derivative(const trace_fit& fit, std::size_t term, std::size_t log, int joint, Eigen::Index s) {
    const Eigen::VectorXd& shape = fit.terms()[term].shape;
    const bool instant = fit.terms()[term].candidate->shape[static_cast<std::size_t>(s)].is_instant;
    const double step = instant ? 1.0 / fit.logs()[log].rows.rate : 1e-4 * std::max(std::abs(shape[s]), 1e-6);
    Eigen::VectorXd above = shape;
    Eigen::VectorXd below = shape;
    above[s] += step;
    below[s] -= step;
    return (torque_of(fit, term, log, joint, above) - torque_of(fit, term, log, joint, below)) / (2.0 * step);
}

observation weighted_rows(const trace_fit& fit, const shape_columns& places) {
    observation rows;
    rows.dof = static_cast<int>(fit.residual().front().size());
    rows.n_base = static_cast<int>(places.total);
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        const traced_log& log = fit.logs()[l];
        if (log.held_back) {
            continue;
        }
        observation_block block{log.rows.file, log.rows.rate, log.rows.t, log.rows.kept, {}, {}};
        for (int j = 0; j < rows.dof; ++j) {
            const auto joint = static_cast<std::size_t>(j);
            Eigen::MatrixXd W = Eigen::MatrixXd::Zero(log.rows.Y[joint].size(), places.total);
            W.leftCols(fit.all_coefficients().size()) =
                fit.columns(l, j) * (1.0 - fit.known_coefficients().array()).matrix().asDiagonal();
            for (std::size_t i = 0; i < fit.terms().size(); ++i) {
                const std::vector<int>& touched = fit.terms()[i].candidate->touched;
                const bool touches = std::find(touched.begin(), touched.end(), j) != touched.end();
                for (Eigen::Index s = 0; s < fit.terms()[i].shape.size() && touches; ++s) {
                    W.col(places.first[i] + s) = derivative(fit, i, l, j, s);
                }
            }
            block.W.emplace_back(fit.weight()[l][joint].asDiagonal() * W);
            block.Y.emplace_back(fit.weight()[l][joint].cwiseProduct(fit.residual()[l][joint]));
        }
        rows.blocks.push_back(std::move(block));
    }
    return rows;
}

/// Columns that the data excites: the others would make the factor singular.
std::vector<Eigen::Index> regular_columns(const stacked_qr& qr, const rank_report& rank) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index c = 0; c < qr.R.cols(); ++c) {
        if (std::find(rank.not_excited.begin(), rank.not_excited.end(), static_cast<int>(c)) ==
            rank.not_excited.end()) {
            kept.push_back(c);
        }
    }
    return kept;
}

Eigen::VectorXd deviations_of(observation rows) {
    const std::vector<double> ones(static_cast<std::size_t>(rows.dof), 1.0);
    stacked_qr qr = factor(triangles_of(rows), ones);
    Eigen::VectorXd deviation = Eigen::VectorXd::Constant(rows.n_base, std::nan(""));
    const std::vector<Eigen::Index> kept = regular_columns(qr, examine(qr));
    for (observation_block& block : rows.blocks) {
        for (Eigen::MatrixXd& W : block.W) {
            W = Eigen::MatrixXd(W(Eigen::all, kept));
        }
    }
    rows.n_base = static_cast<int>(kept.size());
    qr = factor(triangles_of(rows), ones);
    const joint_series residual = residuals(rows, Eigen::VectorXd::Zero(rows.n_base));
    deviation(kept) = robust_covariance(rows, ones, qr, residual).covariance.diagonal().cwiseSqrt();
    return deviation;
}

}  // namespace

std::vector<term_values> values_with_deviations(const trace_fit& fit) {
    std::vector<term_values> values;
    if (fit.terms().empty()) {
        return values;
    }
    const shape_columns places = places_of(fit);
    const Eigen::VectorXd deviation = deviations_of(weighted_rows(fit, places));
    for (std::size_t i = 0; i < fit.terms().size(); ++i) {
        const Eigen::VectorXd linear = fit.coefficients(i);
        const Eigen::VectorXd& shape = fit.terms()[i].shape;
        term_values both{Eigen::VectorXd(linear.size() + shape.size()), Eigen::VectorXd(linear.size() + shape.size())};
        both.value << linear, shape;
        both.deviation << deviation.segment(fit.first_column(i), linear.size()),
            deviation.segment(places.first[i], shape.size());
        values.push_back(std::move(both));
    }
    return values;
}

}  // namespace idim
