#include "base_parameters/regrouping.hpp"

#include <cln/dfloat.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "base_parameters/base_parameter_set.hpp"
#include "base_parameters/sample_point.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

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
    if (std::all_of(samples.begin(), samples.end(), [](prime_field v) { return v.is_zero(); })) {
        return std::vector<prime_field>(candidates.size());
    }
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
        result.add(coefficient, candidates[i]);
    }
    return result;
}

bool agree(const rational& exact, double by_qr) {
    return std::abs(to_double(exact) - by_qr) < 1e-9 * std::max(1.0, std::abs(by_qr));
}

std::vector<prime_field> to_field(const std::vector<rational>& values) {
    std::vector<prime_field> result;
    for (const rational& value : values) {
        result.emplace_back(value);
    }
    return result;
}

std::vector<std::size_t> positions(std::size_t count) {
    std::vector<std::size_t> result(count);
    std::iota(result.begin(), result.end(), std::size_t{0});
    return result;
}

/// The given columns of the rows that are not zero in all of them, as many as an elimination needs.
std::vector<std::vector<prime_field>> restrict_to(const std::vector<std::vector<prime_field>>& rows,
                                                  const std::vector<std::size_t>& columns) {
    std::vector<std::vector<prime_field>> result;
    for (const auto& row : rows) {
        std::vector<prime_field> part;
        for (const std::size_t c : columns) {
            part.push_back(row[c]);
        }
        const bool empty = std::all_of(part.begin(), part.end(), [](prime_field v) { return v.is_zero(); });
        if (!empty && result.size() < columns.size() + 5) {
            result.push_back(part);
        }
    }
    return result;
}

/// Polynomials through the coefficients of several eliminations, columns counted in `local`; empty where one has none.
std::map<std::size_t, std::map<std::size_t, constant_polynomial>> fit_coefficients(
    const std::vector<exact_selection>& eliminations, const std::vector<std::vector<prime_field>>& constants,
    const std::vector<monomial>& monomials, const std::vector<std::size_t>& local, std::size_t first_target) {
    std::map<std::size_t, std::map<std::size_t, constant_polynomial>> table;
    const exact_selection& first = eliminations.front();
    for (std::size_t d = 0; d < first.dropped.size(); ++d) {
        for (std::size_t k = 0; first.dropped[d] >= first_target && k < first.kept.size(); ++k) {
            std::vector<prime_field> values;
            for (const exact_selection& elimination : eliminations) {
                values.push_back(elimination.beta[k][d]);
            }
            const auto residues = fit(monomials, constants, values);
            const auto found = residues ? polynomial(monomials, *residues) : std::nullopt;
            if (!found) {
                return {};
            }
            table[local[first.dropped[d]]][local[first.kept[k]]] = *found;
        }
    }
    return table;
}

}  // namespace

regrouping::regrouping(const standard_regressor& W, const kinematic_tree& tree, const standard_parameters& parameters,
                       const std::vector<std::size_t>& preference)
    : W_(W), angles_(W.graph), tree_(tree), parameters_(parameters), preference_(preference) {
    // Rows for the largest rank there can be, and some to spare: rows of outer joints see few columns.
    points_ = W.columns / W.dof + 3;
    own_constants_ = draw_constants(0);
    own_ = select_exactly(rows_at(own_constants_), preference_);
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

regrouping::field_rows regrouping::rows_at(const std::vector<rational>& constants) const {
    const constant_values values = by_symbol(W_.graph, constants);
    field_rows rows;
    for (int s = 0; s < points_; ++s) {
        const std::size_t first = rows.size();
        rows.resize(first + static_cast<std::size_t>(W_.dof),
                    std::vector<prime_field>(static_cast<std::size_t>(W_.columns)));
        sample_point<prime_field> point(angles_, static_cast<std::uint64_t>(s) + 1, point_height);
        const std::vector<prime_field> entries = point.evaluate_at(W_.graph, values);
        for (std::size_t k = 0; k < entries.size(); ++k) {
            rows[first + static_cast<std::size_t>(W_.row_of_output[k])]
                [static_cast<std::size_t>(W_.column_of_output[k])] = entries[k];
        }
    }
    return rows;
}

std::vector<std::vector<std::size_t>> regrouping::constants_of(const kinematic_joint& joint) const {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < tree_.constants.size(); ++i) {
        const kinematic_constant& constant = tree_.constants[i];
        const GiNaC::symbol& symbol = tree_.constants[constant.is_sine ? i - 1 : i].symbol;
        const std::array<ex, 8> entries = {joint.b,         joint.d,         joint.r,         joint.position()[2],
                                           joint.gamma.cos, joint.alpha.cos, joint.theta.cos, joint.theta.sin};
        const bool enters =
            std::any_of(entries.begin(), entries.end(), [&symbol](const ex& e) { return e.has(symbol); }) ||
            std::any_of(joint.rates.begin(), joint.rates.end(),
                        [&symbol](const joint_rate& rate) { return rate.factor.has(symbol); });
        if (enters && constant.is_sine) {
            groups.back().push_back(i);
        } else if (enters) {
            groups.push_back({i});
        }
    }
    return groups;
}

std::vector<std::size_t> regrouping::columns_of(const std::vector<std::size_t>& among, int link) const {
    std::vector<std::size_t> result;
    std::copy_if(among.begin(), among.end(), std::back_inserter(result),
                 [this, link](std::size_t p) { return parameters_.all[p].joint == link; });
    return result;
}

void regrouping::sample(sampled_regressor& samples, std::size_t s,
                        const std::vector<std::vector<std::size_t>>& own_groups, std::size_t variant) const {
    const std::vector<rational> own = draw_constants(s + 1);
    std::vector<rational> drawn = draw_constants(s + 1 + 1000 * variant);
    for (const std::vector<std::size_t>& group : own_groups) {
        for (const std::size_t i : group) {
            drawn[i] = own[i];
        }
    }
    samples.constants.push_back(to_field(drawn));
    samples.rows.push_back(rows_at(drawn));
}

regrouping::formula_table regrouping::relate_to_antecedent(int link, std::size_t variants,
                                                           sampled_regressor& samples) const {
    const kinematic_joint& joint = tree_.joints[static_cast<std::size_t>(link)];
    const std::vector<std::size_t> targets = columns_of(own_.dropped, link);
    const std::vector<std::vector<std::size_t>> groups = constants_of(joint);
    const std::vector<monomial> monomials = candidate_monomials(groups);
    if (targets.empty()) {
        return {};
    }
    const std::size_t draws = monomials.size() + 3;
    while (samples.rows.size() < draws * variants) {
        sample(samples, samples.rows.size() / variants, groups, samples.rows.size() % variants);
    }
    std::vector<std::size_t> local = columns_of(own_.kept, link);
    for (int kind = 0; joint.antecedent >= 0 && kind <= static_cast<int>(parameter_kind::M); ++kind) {
        const std::size_t p = parameters_.index(joint.antecedent, static_cast<parameter_kind>(kind));
        if (p < parameters_.all.size()) {
            local.push_back(p);
        }
    }
    const std::size_t first_target = local.size();
    local.insert(local.end(), targets.begin(), targets.end());

    std::vector<exact_selection> eliminations;
    std::vector<std::vector<prime_field>> constants;
    for (std::size_t s = 0; s < draws; ++s) {
        field_rows rows;
        for (std::size_t v = 0; v < variants; ++v) {
            const field_rows part = restrict_to(samples.rows[s * variants + v], local);
            rows.insert(rows.end(), part.begin(), part.end());
        }
        const exact_selection elimination = select_exactly(std::move(rows), positions(local.size()));
        const bool depends = !elimination.kept.empty() && elimination.kept.back() < first_target;
        if (!depends ||
            (s > 0 && (elimination.kept != eliminations[0].kept || elimination.dropped != eliminations[0].dropped))) {
            return {};
        }
        eliminations.push_back(elimination);
        constants.push_back(samples.constants[s * variants]);
    }
    return fit_coefficients(eliminations, constants, monomials, local, first_target);
}

regrouping::formula_table regrouping::formulas() const {
    sampled_regressor shared;
    formula_table table;
    const auto in = [](const std::vector<std::size_t>& list, std::size_t p) {
        return std::find(list.begin(), list.end(), p) != list.end();
    };
    for (std::size_t link = 0; link < tree_.joints.size(); ++link) {
        formula_table relations = relate_to_antecedent(static_cast<int>(link), 1, shared);
        if (relations.empty()) {
            sampled_regressor own;
            relations = relate_to_antecedent(static_cast<int>(link), 3, own);
        }
        for (const auto& [dropped, combination] : relations) {
            auto& row = table[dropped];
            for (const auto& [p, coefficient] : combination) {
                if (in(own_.kept, p)) {
                    row[p] += coefficient;
                }
                // Of the antecedent, whose formulas are complete.
                if (const auto inner = table.find(p); inner != table.end()) {
                    for (const auto& [kept, factor] : inner->second) {
                        row[kept] += coefficient * factor;
                    }
                }
            }
        }
    }
    return table;
}

regrouped_column regrouping::column(const formula_table& table, std::size_t k, std::size_t d, double by_qr) const {
    regrouped_column result;
    result.kept = own_.kept[k];
    result.dropped = own_.dropped[d];
    const auto row = table.find(result.dropped);
    if (row != table.end()) {
        const auto entry = row->second.find(result.kept);
        const constant_polynomial found = entry == row->second.end() ? constant_polynomial() : entry->second;
        result.exact = found.value(own_constants_);
        // An irrational number has a fraction with the same residue too: the QR tells.
        if (prime_field(result.exact) == own_.beta[k][d] && agree(result.exact, by_qr)) {
            result.coefficient = found;
            return result;
        }
    }
    // A short fraction if that is what the QR sees too, otherwise the QR's own number.
    bool found = true;
    const rational fraction = reconstruct(own_.beta[k][d], found);
    result.is_exact = found && agree(fraction, by_qr);
    result.exact = result.is_exact ? fraction : cln::rational(cln::cl_DF(by_qr));
    result.coefficient = constant_polynomial(result.exact);
    return result;
}

std::vector<regrouped_column> regrouping::columns(const Eigen::MatrixXd& beta) const {
    const formula_table table = formulas();
    std::vector<regrouped_column> result;
    for (std::size_t k = 0; k < own_.kept.size(); ++k) {
        for (std::size_t d = 0; d < own_.dropped.size(); ++d) {
            if (!own_.beta[k][d].is_zero()) {
                const double by_qr = beta(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d));
                result.push_back(column(table, k, d, by_qr));
            }
        }
    }
    return result;
}

std::vector<std::vector<rational>> regrouping::exact_rows(int point_number) const {
    sample_point<rational> point(angles_, static_cast<std::uint64_t>(point_number) + 1, point_height);
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
