#include "declared_terms.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "effect_evidence.hpp"
#include "link_parameters.hpp"
#include "regrouping.hpp"

namespace idim {

namespace {

constexpr double need_significance = 0.05;
constexpr double declared_z =
    1.0;  ///< gain on data held back, in its deviations, that makes a term needed all the same

/// Whether `name` is that of coefficient `stem` at a joint: "Fv3", or "Fvc3_4" of a pair.
bool is_coefficient(const std::string& name, const std::string& stem, int joint) {
    const std::string start = stem + std::to_string(joint + 1);
    return name.compare(0, start.size(), start) == 0 &&
           (name.size() == start.size() || std::isdigit(static_cast<unsigned char>(name[start.size()])) == 0);
}

/// The base parameter that is standard parameter p and nothing else, or -1.
Eigen::Index own_column(const Eigen::MatrixXd& B, Eigen::Index p) {
    Eigen::Index k = 0;
    const double largest = B.col(p).cwiseAbs().maxCoeff(&k);
    const bool alone =
        largest > 0.0 && (B.col(p).array() != 0.0).count() == 1 && (B.row(k).array() != 0.0).count() == 1;
    return alone ? k : -1;
}

std::vector<traced_log> without_columns(std::vector<traced_log> logs, const std::vector<Eigen::Index>& columns) {
    for (traced_log& log : logs) {
        for (Eigen::MatrixXd& W : log.rows.W) {
            for (const Eigen::Index k : columns) {
                W.col(k).setZero();
            }
        }
    }
    return logs;
}

std::vector<std::string> names_of(const trace_input& input, const declared_term& term) {
    std::vector<std::string> names;
    for (const Eigen::Index k : term.columns) {
        names.emplace_back(input.model->parameter_names[k]);
    }
    return names;
}

/// A term left out and what that did to the fit.
struct elimination {
    std::size_t term;
    double p_value;
    trace_errors without;
};

/// Whether some coefficient is so many deviations from zero that no fit without it is needed to know.
bool is_plainly_there(const trace_fit& fit, const declared_term& term, double correlation_length) {
    constexpr double plain = 5.0;
    return std::any_of(term.columns.begin(), term.columns.end(), [&](Eigen::Index k) {
        return std::abs(fit.chi()[k]) > plain * std::sqrt(correlation_length) * fit.white_deviation(k);
    });
}

/// The least significant of the terms that may go; none where all are needed.
std::optional<elimination> least_supported(const trace_fit& fit, const std::vector<declared_term>& terms) {
    std::optional<elimination> least;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const row_count rows = count_rows(fit, terms[i].place.joints, fit.residual());
        if (is_plainly_there(fit, terms[i], rows.length())) {
            continue;
        }
        const std::vector<traced_log> fewer = without_columns(fit.logs(), terms[i].columns);
        const trace_fit reduced(fewer, fit.terms(), fit.noise());
        const double m = std::max(1, fit.parameters() - reduced.parameters());
        const double p = partial_f(rows, reduced.loss() - fit.loss(), m).p_value;
        const double z = loss_difference(fit, reduced.residual(), fit.residual(), rows.length(), true);
        if (p > need_significance && z < declared_z && p > (least ? least->p_value : 0.0)) {
            least = elimination{i, p, {errors_of(reduced, false), errors_of(reduced, true)}};
        }
    }
    return least;
}

}  // namespace

std::vector<declared_term> separable_terms(const trace_input& input) {
    const idim_model_interface& model = *input.model;
    const Eigen::MatrixXd B = regrouping_of(model);
    std::vector<declared_term> terms;
    for (const effect_place& place : input.declared) {
        declared_term term{place, {}};
        for (int e = 0; e < input.catalogue->count; ++e) {
            const idim_effect& effect = input.catalogue->effects[e];
            for (int c = 0; place.effect == effect.name && c < effect.n_linear; ++c) {
                for (Eigen::Index p = 0; p < model.n_standard; ++p) {
                    const Eigen::Index k = own_column(B, p);
                    if (k >= 0 &&
                        is_coefficient(model.standard_names[p], effect.linear_names[c], place.joints.front())) {
                        term.columns.push_back(k);
                    }
                }
            }
        }
        std::sort(term.columns.begin(), term.columns.end());
        if (!term.columns.empty()) {
            terms.push_back(std::move(term));
        }
    }
    return terms;
}

std::vector<unsupported_term> find_unsupported(const trace_fit& fit, const trace_input& input) {
    std::vector<unsupported_term> found;
    std::vector<declared_term> left = separable_terms(input);
    std::vector<traced_log> logs = fit.logs();
    while (const std::optional<elimination> next = least_supported(trace_fit(logs, fit.terms(), fit.noise()), left)) {
        const declared_term& term = left[next->term];
        logs = without_columns(std::move(logs), term.columns);
        found.push_back({term.place, names_of(input, term), next->p_value, next->without});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(next->term));
    }
    return found;
}

}  // namespace idim
