#include "base_parameters/regrouping.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base_parameters/base_parameter_set.hpp"
#include "base_parameters/sample_point.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t most_monomials = 300;
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
    if (solution.kept.size() != candidates.size() || solution.dropped.size() != 1 || solution.dropped[0] != candidates.size()) {
        return std::nullopt;
    }
    std::vector<prime_field> coefficients;
    for (const auto& row : solution.beta) {
        coefficients.push_back(row[0]);
    }
    return coefficients;
}

std::optional<constant_polynomial> polynomial(const std::vector<monomial>& candidates, const std::vector<prime_field>& residues) {
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

regrouping::regrouping(const standard_regressor& W, const kinematic_tree& tree, const std::vector<std::size_t>& preference)
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
            rows[first + static_cast<std::size_t>(W_.row_of_output[k])][static_cast<std::size_t>(W_.column_of_output[k])] = entries[k];
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

constant_polynomial regrouping::number(prime_field residue) const {
    bool found = true;
    const rational value = reconstruct(residue, found);
    if (!found) {
        throw rank_disagreement("base parameters: a regrouping coefficient is neither a polynomial in the constants nor a short "
                                "fraction; give the geometry in named constants");
    }
    return {{{value, {}}}};
}

std::vector<regrouped_column> regrouping::columns() const {
    const auto groups = constant_groups();
    const std::vector<rational> base = draw_constants(1);
    const exact_selection generic = select_at(base);
    const bool is_generic = generic.kept == own_.kept && generic.dropped == own_.dropped;

    // Which constants each coefficient depends on: one elimination with one group changed each.
    std::vector<exact_selection> changed;
    for (std::size_t g = 0; is_generic && g < groups.size(); ++g) {
        std::vector<rational> constants = base;
        const std::vector<rational> other = draw_constants(2);
        for (const std::size_t i : groups[g]) {
            constants[i] = other[i];
        }
        changed.push_back(select_at(constants));
    }
    std::map<std::vector<std::size_t>, std::vector<monomial>> candidates;
    std::size_t needed = 0;
    const auto dependence = [&](std::size_t k, std::size_t d) {
        std::vector<std::size_t> set;
        for (std::size_t g = 0; g < changed.size(); ++g) {
            if (changed[g].kept != generic.kept || !(changed[g].beta[k][d] == generic.beta[k][d])) {
                set.push_back(g);
            }
        }
        return set;
    };
    for (std::size_t k = 0; is_generic && k < own_.kept.size(); ++k) {
        for (std::size_t d = 0; d < own_.dropped.size(); ++d) {
            const std::vector<std::size_t> set = dependence(k, d);
            if (candidates.count(set) == 0) {
                std::vector<std::vector<std::size_t>> chosen;
                for (const std::size_t g : set) {
                    chosen.push_back(groups[g]);
                }
                candidates[set] = set.size() > 6 ? std::vector<monomial>{} : candidate_monomials(chosen);
                if (candidates[set].size() <= most_monomials) {
                    needed = std::max(needed, candidates[set].size());
                }
            }
        }
    }
    std::vector<exact_selection> samples = {generic};
    std::vector<std::vector<prime_field>> constants = {to_field(base)};
    for (std::size_t s = 1; is_generic && needed > 1 && s < needed + 3; ++s) {
        const std::vector<rational> drawn = draw_constants(s + 2);
        samples.push_back(select_at(drawn));
        constants.push_back(to_field(drawn));
        if (samples.back().kept != own_.kept) {
            samples.pop_back();
            constants.pop_back();
        }
    }

    std::vector<regrouped_column> result;
    for (std::size_t k = 0; k < own_.kept.size(); ++k) {
        for (std::size_t d = 0; d < own_.dropped.size(); ++d) {
            std::optional<constant_polynomial> coefficient;
            if (is_generic) {
                const auto& monomials = candidates[dependence(k, d)];
                if (!monomials.empty() && monomials.size() <= most_monomials) {
                    std::vector<prime_field> values;
                    for (const exact_selection& sample : samples) {
                        values.push_back(sample.beta[k][d]);
                    }
                    const bool vanishes = std::all_of(values.begin(), values.end(), [](prime_field v) { return v.is_zero(); });
                    if (vanishes && own_.beta[k][d].is_zero()) {
                        continue;
                    }
                    if (const auto residues = fit(monomials, constants, values)) {
                        coefficient = polynomial(monomials, *residues);
                    }
                }
            }
            if (!coefficient || !(prime_field(coefficient->value(own_constants_)) == own_.beta[k][d])) {
                coefficient = number(own_.beta[k][d]);
            }
            if (!own_.beta[k][d].is_zero()) {
                result.push_back({own_.kept[k], own_.dropped[d], *coefficient, coefficient->value(own_constants_)});
            }
        }
    }
    return result;
}

void regrouping::prove(const std::vector<regrouped_column>& columns) const {
    const constant_values values = by_symbol(W_.graph, own_constants_);
    for (int s = 0; s < points_; ++s) {
        sample_point<rational> point(static_cast<std::uint64_t>(s) + 1, point_height);
        const std::vector<rational> entries = point.evaluate_at(W_.graph, values);
        const auto width = static_cast<std::size_t>(W_.columns);
        std::vector<rational> W(static_cast<std::size_t>(W_.dof) * width, rational(0));
        for (std::size_t k = 0; k < entries.size(); ++k) {
            W[static_cast<std::size_t>(W_.row_of_output[k]) * width + static_cast<std::size_t>(W_.column_of_output[k])] = entries[k];
        }
        for (std::size_t row = 0; row < static_cast<std::size_t>(W_.dof); ++row) {
            std::vector<rational> rest;
            for (const std::size_t d : own_.dropped) {
                rest.push_back(W[row * width + d]);
            }
            for (std::size_t c = 0; c < columns.size(); ++c) {
                const auto at = std::find(own_.dropped.begin(), own_.dropped.end(), columns[c].dropped) - own_.dropped.begin();
                auto& remainder = rest[static_cast<std::size_t>(at)];
                remainder = remainder - columns[c].exact * W[row * width + columns[c].kept];
            }
            if (!std::all_of(rest.begin(), rest.end(), [](const rational& r) { return cln::zerop(r); })) {
                throw rank_disagreement(fmt::format("base parameters: rank {} modulo a prime, but the regrouping does not hold "
                                                    "exactly at rational point {}",
                                                    own_.kept.size(), s + 1));
            }
        }
    }
}

}  // namespace idim::generator
