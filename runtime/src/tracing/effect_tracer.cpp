#include "effect_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "parallel.hpp"
#include "shape_search.hpp"

namespace idim {

namespace {

constexpr double significance = 0.01;        ///< corrected for everything tried
constexpr double worth_a_look = 0.2;         ///< corrected p of the quick columns, to look at the exact ones
constexpr double least_held_back_z = 2.33;   ///< one-sided 1 %
constexpr double least_moving_z = 2.0;       ///< one-sided 2.3 %, away from reversals
constexpr double least_explained = 0.015;    ///< of the residual variance on data not fitted to
constexpr double indistinguishable_z = 2.0;  ///< two-sided 5 %
constexpr double look_alike = 0.8;           ///< correlation of what two candidates predict outside the span
constexpr double needed_z = 1.0;             ///< a term that gains less on data not fitted to has become needless

/// Torque of the effect at one joint over the fitted logs must not exceed what the joint has at all.
bool is_plausible(const trace_fit& fit, const effect_evidence& evidence) {
    const effect_candidate& candidate = *evidence.term.candidate;
    const auto m = static_cast<Eigen::Index>(candidate.linear.size());
    std::vector<double> effect(candidate.touched.size(), 0.0);
    std::vector<double> all = effect;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        if (fit.logs()[l].held_back) {
            continue;
        }
        const Eigen::Index place = candidate.per_log ? m * static_cast<Eigen::Index>(l) : 0;
        const std::vector<Eigen::MatrixXd> rows = candidate.touched_rows(fit.logs()[l], evidence.term.shape);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            effect[k] += (rows[k] * evidence.coefficient.segment(place, m)).squaredNorm();
            all[k] += fit.logs()[l].rows.Y[static_cast<std::size_t>(candidate.touched[k])].squaredNorm();
        }
    }
    return std::equal(effect.begin(), effect.end(), all.begin(), std::less_equal<>());
}

bool is_negligible(const effect_evidence& evidence) {
    const std::vector<linear_bound>& linear = evidence.term.candidate->linear;
    for (std::size_t c = 0; c < linear.size(); ++c) {
        if (!linear[c].is_nuisance &&
            std::abs(evidence.coefficient[static_cast<Eigen::Index>(c)]) >= linear[c].negligible) {
            return false;
        }
    }
    return true;
}

/// Whether the joints at which the effect acts are predicted worse in some log it was not fitted to: the mean of their
/// squared errors, each over what it was before. Added up as they are, the error would be that of the joint with the
/// largest torque, which hardly feels what a light joint beside it gains.
bool raises_an_error(const trace_fit& fit, const effect_evidence& evidence) {
    const log_series left = residual_with(fit, evidence);
    const std::vector<int>& joints = evidence.term.candidate->joints;
    for (std::size_t l = 0; l < left.size(); ++l) {
        double parts = 0.0;
        for (const int joint : joints) {
            const auto j = static_cast<std::size_t>(joint);
            const double before = fit.residual()[l][j].squaredNorm();
            parts += before > 0.0 ? left[l][j].squaredNorm() / before : 1.0;
        }
        if (fit.logs()[l].held_back && parts > static_cast<double>(joints.size())) {
            return true;
        }
    }
    return false;
}

/// Whether a searched shape lies at an end of its range: there the search has found none.
bool is_at_end_of_range(const effect_term& term) {
    constexpr double near = 5e-3;  // of the bound: golden section comes to a thousandth of a grid step
    for (std::size_t s = 0; s < term.candidate->shape.size(); ++s) {
        const shape_bound& bound = term.candidate->shape[s];
        const double value = term.shape[static_cast<Eigen::Index>(s)];
        if (value <= bound.low + near * std::abs(bound.low) || value >= bound.high - near * std::abs(bound.high)) {
            return true;
        }
    }
    return false;
}

std::string objection_to(const trace_fit& fit, const tried_candidate& tried) {
    const effect_evidence& evidence = tried.evidence;
    if (tried.p_value >= significance) {
        return "not significant";
    }
    for (const held_back_gain& log : evidence.held_back) {
        if (log.all <= 0.0) {
            return "makes a log it was not fitted to worse";
        }
    }
    if (evidence.z_all() < least_held_back_z) {
        return "no sure gain on data it was not fitted to";
    }
    if (evidence.z_moving() < least_moving_z) {
        return "explains rows at reversals only";
    }
    if (evidence.explained_fraction < least_explained) {
        return "too small to be told from what every model leaves";
    }
    if (raises_an_error(fit, evidence)) {
        return "raises the error of a log it was not fitted to";
    }
    if (is_negligible(evidence)) {
        return "smaller than what sampling makes";
    }
    if (is_at_end_of_range(evidence.term)) {
        return "its shape lies at the end of the range searched";
    }
    if (!is_plausible(fit, evidence)) {
        return "larger than the torque of its joint";
    }
    return {};
}

bool ranks_before(const tried_candidate& a, const tried_candidate& b) {
    if (a.objection.empty() != b.objection.empty()) {
        return a.objection.empty();
    }
    if (a.objection.empty()) {
        return a.evidence.score > b.evidence.score;
    }
    if (a.p_value != b.p_value) {
        return a.p_value < b.p_value;
    }
    return a.evidence.f_statistic > b.evidence.f_statistic;
}

/// Weighted change of the residual of the fitted logs.
Eigen::VectorXd prediction_of(const trace_fit& fit, const log_series& left) {
    std::vector<double> values;
    for (std::size_t l = 0; l < left.size(); ++l) {
        for (std::size_t j = 0; j < left[l].size() && !fit.logs()[l].held_back; ++j) {
            const Eigen::VectorXd change = (fit.residual()[l][j] - left[l][j]).cwiseProduct(fit.weight()[l][j]);
            values.insert(values.end(), change.begin(), change.end());
        }
    }
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double weighted_norm(const trace_fit& fit, Eigen::Index column) {
    double sum = 0.0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        for (std::size_t j = 0; j < fit.weight()[l].size() && !fit.logs()[l].held_back; ++j) {
            sum += fit.columns(l, static_cast<int>(j)).col(column).cwiseProduct(fit.weight()[l][j]).squaredNorm();
        }
    }
    return std::sqrt(sum);
}

/// Columns of the fit whose combination the candidate's columns are: those that bring more than a hundredth of it.
std::vector<Eigen::Index> absorbing_columns(const trace_fit& fit, const effect_evidence& evidence) {
    constexpr double least_share = 0.01;
    const projected_columns columns = fit.project(*evidence.term.candidate, evidence.term.shape, false);
    Eigen::VectorXd share = Eigen::VectorXd::Zero(fit.all_coefficients().size());
    for (Eigen::Index c = 0; c < columns.on_basis.cols(); ++c) {
        if (columns.scale[c] > 0.0) {
            share += fit.basis_times(columns.on_basis.col(c)).cwiseAbs() / columns.scale[c];
        }
    }
    std::vector<Eigen::Index> found;
    for (Eigen::Index k = 0; k < share.size(); ++k) {
        share[k] *= weighted_norm(fit, k);
        if (share[k] > least_share) {
            found.push_back(k);
        }
    }
    std::sort(found.begin(), found.end(), [&](Eigen::Index a, Eigen::Index b) { return share[a] > share[b]; });
    return found;
}

trace_fit without(const trace_fit& fit, std::size_t term) {
    std::vector<effect_term> terms = fit.terms();
    terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(term));
    return trace_fit(fit.logs(), std::move(terms), fit.noise());
}

}  // namespace

std::optional<effect_survey> survey(const trace_fit& fit, const std::vector<candidate_pointer>& candidates,
                                    const std::function<bool()>& go_on) {
    effect_survey result;
    std::vector<effect_evidence> found(candidates.size());
    std::atomic<bool> stopped = false;
    for_each_on_all_cores(candidates.size(), [&](std::size_t i) {
        if (go_on && !go_on()) {
            stopped = true;
        }
        if (!stopped) {
            found[i] = search_shape(fit, candidates[i], worth_a_look);
        }
    });
    if (stopped) {
        return std::nullopt;
    }
    for (const effect_evidence& evidence : found) {
        result.tests += evidence.shapes_tried;
    }
    result.candidates.resize(found.size());
    for_each_on_all_cores(found.size(), [&](std::size_t i) {
        tried_candidate& tried = result.candidates[i];
        const double own = corrected(found[i].p_value, found[i].shapes_tried);
        tried.p_value = corrected(own, static_cast<double>(candidates.size()));
        if (tried.p_value < worth_a_look) {
            test_on_held_back(fit, found[i]);
        }
        tried.evidence = std::move(found[i]);
        tried.objection = objection_to(fit, tried);
    });
    for (const tried_candidate& tried : result.candidates) {
        if (tried.evidence.within_span) {
            result.within_span.push_back(
                {tried.evidence.term.candidate->place(), absorbing_columns(fit, tried.evidence)});
        }
    }
    std::stable_sort(result.candidates.begin(), result.candidates.end(), ranks_before);
    return result;
}

std::vector<effect_place> confusable_with(const trace_fit& fit, const effect_survey& all, std::size_t accepted) {
    const effect_evidence& best = all.candidates[accepted].evidence;
    const log_series best_left = residual_with(fit, best);
    const Eigen::VectorXd best_prediction = prediction_of(fit, best_left);
    std::vector<effect_place> places;
    for (std::size_t i = 0; i < all.candidates.size(); ++i) {
        const tried_candidate& other = all.candidates[i];
        if (i == accepted || other.evidence.held_back.empty() || other.p_value >= significance) {
            continue;
        }
        const log_series left = residual_with(fit, other.evidence);
        const Eigen::VectorXd prediction = prediction_of(fit, left);
        const double norms = prediction.norm() * best_prediction.norm();
        const bool alike = norms > 0.0 && prediction.dot(best_prediction) > look_alike * norms;
        if (alike && loss_difference(fit, left, best_left, best.correlation_length) < indistinguishable_z) {
            places.push_back(other.evidence.term.candidate->place());
        }
    }
    return places;
}

trace_fit with_refined_shapes(const trace_fit& fit) {
    std::vector<effect_term> terms = fit.terms();
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t i = 0; i < terms.size(); ++i) {
            if (terms[i].shape.size() > 0) {
                const trace_fit others = without(trace_fit(fit.logs(), terms, fit.noise()), i);
                const double reach = (pass == 0 ? 0.2 : 0.02) * std::abs(terms[i].shape[0]);
                terms[i] = refine_shape(others, terms[i], reach).term;
            }
        }
    }
    return fit_with_own_noise(fit.logs(), terms, &fit.noise());
}

std::optional<std::size_t> needless_term(const trace_fit& fit, std::size_t first_removable) {
    std::optional<std::size_t> worst;
    double least = needed_z;
    for (std::size_t i = first_removable; i < fit.terms().size(); ++i) {
        const trace_fit reduced = without(fit, i);
        const double length = correlation_length(fit, fit.residual(), fit.terms()[i].candidate->touched.front());
        const double z = loss_difference(fit, reduced.residual(), fit.residual(), length, true);
        if (z < least) {
            least = z;
            worst = i;
        }
    }
    return worst;
}

}  // namespace idim
