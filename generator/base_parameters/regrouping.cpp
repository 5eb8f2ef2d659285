#include "base_parameters/regrouping.hpp"

#include <cln/dfloat.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base_parameters/base_parameter_set.hpp"
#include "base_parameters/sample_point.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t most_groups = 5;     // constants that one coefficient may depend on and still be a formula
constexpr std::uint64_t point_height = 7;  // small rationals keep the exact proof short

constant_values by_symbol(const expression_graph& graph, const std::vector<rational>& constants) {
    constant_values values(graph.symbols().size(), rational(0));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (graph.symbols()[i].role == symbol_role::constant) {
            values[i] = constants[static_cast<std::size_t>(graph.symbols()[i].index)];
        }
    }
    return values;
}

/// Coefficients of the candidates that reproduce `samples`, or nothing.
std::optional<std::vector<prime_field>> fit(const std::vector<monomial>& candidates,
                                            const std::vector<std::vector<prime_field>>& constants,
                                            const std::vector<prime_field>& samples) {
    std::vector<std::vector<prime_field>> rows;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        std::vector<prime_field> row;
        for (const monomial& m : candidates) {
            row.push_back(evaluate(m, constants[s]));
        }
        row.push_back(samples[s]);
        rows.push_back(row);
    }
    std::vector<std::size_t> order;
    for (std::size_t c = 0; c <= candidates.size(); ++c) {
        order.push_back(c);
    }
    const exact_selection solution = select_exactly(rows, order);
    if (solution.kept.size() != candidates.size() || solution.dropped.size() != 1 ||
        solution.dropped[0] != candidates.size()) {
        return std::nullopt;
    }
    std::vector<prime_field> coefficients;
    for (const auto& row : solution.beta) {
        coefficients.push_back(row[0]);
    }
    return coefficients;
}

std::optional<constant_polynomial> polynomial(const std::vector<monomial>& candidates,
                                              const std::vector<prime_field>& residues) {
    constant_polynomial result;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        bool found = true;
        const rational coefficient = reconstruct(residues[i], found);
        if (!found) {
            return std::nullopt;
        }
        if (!cln::zerop(coefficient)) {
            result.terms.emplace_back(coefficient, candidates[i]);
        }
    }
    return result;
}

std::vector<prime_field> to_field(const std::vector<rational>& values) {
    std::vector<prime_field> result;
    for (const rational& value : values) {
        result.emplace_back(value);
    }
    return result;
}

}  // namespace

regrouping::regrouping(const standard_regressor& W, const kinematic_tree& tree,
                       const std::vector<std::size_t>& preference)
    : W_(W), tree_(tree), preference_(preference) {
    // Rows for the largest rank there can be, and some to spare: rows of outer joints see few columns.
    points_ = W.columns / W.dof + 3;
    own_constants_ = draw_constants(0);
    own_ = select_at(own_constants_);
}

std::vector<rational> regrouping::draw_constants(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::vector<rational> values;
    for (const kinematic_constant& constant : tree_.constants) {
        const rational drawn = static_cast<unsigned long>(random() >> 34) + 1;
        if (seed == 0) {
            values.push_back(cln::the<cln::cl_RA>(constant.value.to_cl_N()));
        } else if (constant.angle < 0) {
            values.push_back(drawn);
        } else if (!constant.is_sine) {
            values.push_back((1 - drawn * drawn) / (1 + drawn * drawn));
            values.push_back(2 * drawn / (1 + drawn * drawn));  // its sine is the next constant
        }
    }
    return values;
}

exact_selection regrouping::select_at(const std::vector<rational>& constants) const {
    const constant_values values = by_symbol(W_.graph, constants);
    std::vector<std::vector<prime_field>> rows;
    for (int s = 0; s < points_; ++s) {
        const std::size_t first = rows.size();
        rows.resize(first + static_cast<std::size_t>(W_.dof),
                    std::vector<prime_field>(static_cast<std::size_t>(W_.columns)));
        sample_point<prime_field> point(static_cast<std::uint64_t>(s) + 1, point_height);
        const std::vector<prime_field> entries = point.evaluate_at(W_.graph, values);
        for (std::size_t k = 0; k < entries.size(); ++k) {
            rows[first + static_cast<std::size_t>(W_.row_of_output[k])]
                [static_cast<std::size_t>(W_.column_of_output[k])] = entries[k];
        }
    }
    return select_exactly(std::move(rows), preference_);
}

std::vector<std::vector<std::size_t>> regrouping::constant_groups() const {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < tree_.constants.size(); ++i) {
        if (tree_.constants[i].is_sine) {
            groups.back().push_back(i);
        } else {
            groups.push_back({i});
        }
    }
    return groups;
}

std::vector<std::size_t> regrouping::dependence(const elimination_series& series, std::size_t k, std::size_t d) const {
    const exact_selection& base = series.samples.front();
    std::vector<std::size_t> groups;
    for (std::size_t g = 0; g < series.changed.size(); ++g) {
        const exact_selection& other = series.changed[g];
        if (other.kept != base.kept || !(other.beta[k][d] == base.beta[k][d])) {
            groups.push_back(g);
        }
    }
    return groups;
}

const std::vector<monomial>& regrouping::candidates(elimination_series& series,
                                                    const std::vector<std::size_t>& set) const {
    const auto [at, fresh] = series.candidates.try_emplace(set);
    if (fresh && set.size() <= most_groups) {
        std::vector<std::vector<std::size_t>> chosen;
        for (const std::size_t g : set) {
            chosen.push_back(series.groups[g]);
        }
        at->second = candidate_monomials(chosen);
    }
    return at->second;
}

regrouping::elimination_series regrouping::eliminate_at_random_constants() const {
    elimination_series series;
    series.groups = constant_groups();
    const std::vector<rational> base = draw_constants(1);
    const std::vector<rational> other = draw_constants(2);
    series.samples.push_back(select_at(base));
    series.constants.push_back(to_field(base));
    if (series.samples.front().kept != own_.kept || series.samples.front().dropped != own_.dropped) {
        return {};
    }
    for (const std::vector<std::size_t>& group : series.groups) {
        std::vector<rational> constants = base;
        for (const std::size_t i : group) {
            constants[i] = other[i];
        }
        series.changed.push_back(select_at(constants));
    }
    std::size_t needed = 0;
    for_each_coefficient([&](std::size_t k, std::size_t d) {
        needed = std::max(needed, candidates(series, dependence(series, k, d)).size());
    });
    for (std::size_t s = 1; needed > 1 && s < needed + 3; ++s) {
        const std::vector<rational> drawn = draw_constants(s + 2);
        const exact_selection sample = select_at(drawn);
        if (sample.kept == own_.kept) {
            series.samples.push_back(sample);
            series.constants.push_back(to_field(drawn));
        }
    }
    return series;
}

std::optional<constant_polynomial> regrouping::formula(elimination_series& series, std::size_t k, std::size_t d) const {
    if (series.samples.empty()) {
        return std::nullopt;
    }
    const std::vector<monomial>& monomials = candidates(series, dependence(series, k, d));
    if (monomials.empty()) {
        return std::nullopt;
    }
    std::vector<prime_field> values;
    for (const exact_selection& sample : series.samples) {
        values.push_back(sample.beta[k][d]);
    }
    const auto residues = fit(monomials, series.constants, values);
    const auto found = residues ? polynomial(monomials, *residues) : std::nullopt;
    const bool holds = found && prime_field(found->value(own_constants_)) == own_.beta[k][d];
    return holds ? found : std::nullopt;
}

regrouped_column regrouping::column(elimination_series& series, std::size_t k, std::size_t d, double by_qr) const {
    regrouped_column result{own_.kept[k], own_.dropped[d], {}, true, 0};
    if (const auto symbolic = formula(series, k, d)) {
        result.coefficient = *symbolic;
    } else {
        // A short fraction if that is what the QR sees too, otherwise the QR's own number.
        bool found = true;
        const rational fraction = reconstruct(own_.beta[k][d], found);
        result.is_exact = found && std::abs(to_double(fraction) - by_qr) < 1e-9 * std::max(1.0, std::abs(by_qr));
        const rational value = result.is_exact ? fraction : cln::rational(cln::cl_DF(by_qr));
        result.coefficient.terms.emplace_back(value, monomial{});
    }
    result.exact = result.coefficient.value(own_constants_);
    return result;
}

std::vector<regrouped_column> regrouping::columns(const Eigen::MatrixXd& beta) const {
    elimination_series series = eliminate_at_random_constants();
    std::vector<regrouped_column> result;
    for_each_coefficient([&](std::size_t k, std::size_t d) {
        const double by_qr = beta(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d));
        result.push_back(column(series, k, d, by_qr));
    });
    return result;
}

void regrouping::for_each_coefficient(const std::function<void(std::size_t, std::size_t)>& visit) const {
    for (std::size_t k = 0; k < own_.kept.size(); ++k) {
        for (std::size_t d = 0; d < own_.dropped.size(); ++d) {
            if (!own_.beta[k][d].is_zero()) {
                visit(k, d);
            }
        }
    }
}

std::vector<std::vector<rational>> regrouping::exact_rows(int point_number) const {
    sample_point<rational> point(static_cast<std::uint64_t>(point_number) + 1, point_height);
    const std::vector<rational> entries = point.evaluate_at(W_.graph, by_symbol(W_.graph, own_constants_));
    std::vector<std::vector<rational>> rows(static_cast<std::size_t>(W_.dof),
                                            std::vector<rational>(static_cast<std::size_t>(W_.columns), rational(0)));
    for (std::size_t k = 0; k < entries.size(); ++k) {
        rows[static_cast<std::size_t>(W_.row_of_output[k])][static_cast<std::size_t>(W_.column_of_output[k])] =
            entries[k];
    }
    return rows;
}

int regrouping::prove(const std::vector<regrouped_column>& columns) const {
    std::vector<std::size_t> exact = own_.dropped;
    for (const regrouped_column& column : columns) {
        if (!column.is_exact) {
            exact.erase(std::remove(exact.begin(), exact.end(), column.dropped), exact.end());
        }
    }
    for (int s = 0; s < points_; ++s) {
        for (std::vector<rational>& row : exact_rows(s)) {
            for (const regrouped_column& column : columns) {
                row[column.dropped] = row[column.dropped] - column.exact * row[column.kept];
            }
            const bool holds =
                std::all_of(exact.begin(), exact.end(), [&row](std::size_t d) { return cln::zerop(row[d]); });
            if (!holds) {
                throw rank_disagreement(
                    fmt::format("base parameters: rank {} modulo a prime, but the regrouping does not hold "
                                "exactly at rational point {}",
                                own_.kept.size(), s + 1));
            }
        }
    }
    return static_cast<int>(own_.dropped.size() - exact.size());
}

}  // namespace idim::generator
