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
#include <utility>

#include "base_parameters/base_parameter_set.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

constexpr std::size_t spare_rows = 5;   // of an elimination: what holds in them too is no accident
constexpr std::size_t spare_draws = 3;  // of a fit, likewise

/// An irrational number has a fraction with the same residue too, but one with long parts: of random residues one in a
/// million has a fraction as short as this.
bool is_short(const constant_polynomial& polynomial) {
    static const rational longest = 1 << 20;
    return std::all_of(polynomial.terms.begin(), polynomial.terms.end(), [](const auto& term) {
        return cln::abs(cln::numerator(term.second)) < longest && cln::denominator(term.second) < longest;
    });
}

prime_field to_field(const rational& value) {
    return prime_field(value);
}

std::vector<prime_field> to_field(const std::vector<rational>& values) {
    std::vector<prime_field> result;
    for (const rational& value : values) {
        result.push_back(to_field(value));
    }
    return result;
}

std::vector<std::size_t> positions(std::size_t count) {
    std::vector<std::size_t> result(count);
    std::iota(result.begin(), result.end(), std::size_t{0});
    return result;
}

/// Appends some columns of the first rows of a matrix.
void append_columns(const field_matrix& from, const std::vector<std::size_t>& columns, std::size_t rows,
                    field_matrix& to) {
    for (std::size_t r = 0; r < std::min(rows, from.rows()); ++r) {
        std::vector<prime_field> part;
        for (const std::size_t c : columns) {
            part.push_back(from.row(r)[c]);
        }
        to.append(part);
    }
}

/// Polynomials in the given monomials through several samples of values: column m + i of `samples` holds value i, the
/// first m columns the monomials. Empty where there is none.
std::vector<constant_polynomial> fit(const std::vector<monomial>& monomials, const field_matrix& samples) {
    const exact_selection solution = select_exactly(samples, positions(samples.columns()));
    if (solution.kept != positions(monomials.size())) {
        return {};
    }
    std::vector<constant_polynomial> result(samples.columns() - monomials.size());
    for (std::size_t d = 0; d < solution.dropped.size(); ++d) {
        for (std::size_t k = 0; k < monomials.size(); ++k) {
            bool found = true;
            const rational coefficient = reconstruct(solution.beta[k][d], found);
            if (!found) {
                return {};
            }
            result[solution.dropped[d] - monomials.size()].add(coefficient, monomials[k]);
        }
    }
    return result;
}

bool enters(const GiNaC::symbol& symbol, const kinematic_joint& joint) {
    const std::array<ex, 8> entries = {joint.b,         joint.d,         joint.r,         joint.position()[2],
                                       joint.gamma.cos, joint.alpha.cos, joint.theta.cos, joint.theta.sin};
    return std::any_of(entries.begin(), entries.end(), [&symbol](const ex& e) { return e.has(symbol); }) ||
           std::any_of(joint.rates.begin(), joint.rates.end(),
                       [&symbol](const joint_rate& rate) { return rate.factor.has(symbol); });
}

/// Each loop closes at half of the points of the field; with very many of them at hardly any.
void check_tries(std::size_t tried, std::size_t found) {
    constexpr std::size_t most = 100000;
    if (tried > most * (found + 1)) {
        throw rank_disagreement("base parameters: too many loops, no points are found where all of them close");
    }
}

std::vector<prime_field> values_of(const std::vector<monomial>& monomials, const std::vector<prime_field>& constants) {
    std::vector<prime_field> result;
    for (const monomial& m : monomials) {
        result.push_back(evaluate(m, constants));
    }
    return result;
}

}  // namespace

regrouping::regrouping(const standard_regressor& W, const kinematic_tree& tree, const standard_parameters& parameters,
                       const std::vector<std::size_t>& preference)
    : W_(W),
      tree_(tree),
      parameters_(parameters),
      evaluator_(W.graph, [](const rational& value) { return to_field(value); }),
      // Rows for the largest rank there can be, and some to spare: rows of outer joints see few columns. Never so few
      // that a joint is likely to turn the same way at all of them, where Coulomb friction looks like an offset.
      points_(std::max(static_cast<int>(W.columns / W.dof) + 3, 16)),
      own_constants_(constant_values(tree)),
      is_kept_(W.columns, false) {
    const std::vector<prime_field> constants = to_field(own_constants_);
    field_matrix rows(W.columns);
    std::size_t found = 0;
    for (std::uint64_t seed = 1; found < static_cast<std::size_t>(points_); ++seed) {
        check_tries(seed, found);
        sample_point<prime_field> point(W, seed);
        const std::vector<std::vector<prime_field>> at_point = point.rows(evaluator_, constants);
        for (const std::vector<prime_field>& row : at_point) {
            rows.append(row);
        }
        found += at_point.empty() ? 0 : 1;
    }
    own_ = select_exactly(rows, preference);
    const std::vector<std::size_t> rigid = without_effects(preference);
    kept_of_rigid_ = rigid.size() == preference.size() ? own_.kept : select_exactly(rows, rigid).kept;
    for (const std::size_t p : own_.kept) {
        is_kept_[p] = true;
    }
}

std::vector<std::size_t> regrouping::without_effects(const std::vector<std::size_t>& columns) const {
    std::vector<std::size_t> result;
    std::copy_if(columns.begin(), columns.end(), std::back_inserter(result),
                 [this](std::size_t p) { return parameters_.all[p].is_of_link(); });
    return result;
}

std::vector<std::size_t> regrouping::inertial(const std::vector<std::size_t>& columns) const {
    std::vector<std::size_t> result;
    std::copy_if(columns.begin(), columns.end(), std::back_inserter(result),
                 [this](std::size_t p) { return parameters_.all[p].kind != parameter_kind::effect; });
    return result;
}

std::vector<prime_field> regrouping::draw_constants(std::uint64_t seed) const {
    const prime_field one(std::uint64_t{1});
    std::mt19937_64 random(seed);
    std::vector<prime_field> values;
    for (const kinematic_constant& constant : tree_.constants) {
        const prime_field drawn((random() >> 34) + 1);
        if (constant.angle < 0) {
            values.push_back(drawn);
        } else if (!constant.is_sine) {
            const prime_field norm = one + drawn * drawn;
            values.push_back((one - drawn * drawn) / norm);
            values.push_back((drawn + drawn) / norm);  // its sine is the next constant
        }
    }
    return values;
}

regrouping::constants_draw regrouping::draw(std::size_t s, const std::vector<std::vector<std::size_t>>& groups,
                                            std::size_t variant) {
    const std::vector<prime_field> own = draw_constants(s + 1);
    constants_draw result{draw_constants(s + 1 + 1000 * variant), field_matrix(W_.columns)};
    for (const std::vector<std::size_t>& group : groups) {
        for (const std::size_t i : group) {
            result.constants[i] = own[i];
        }
    }
    for (std::size_t state = 0; result.rows.rows() < rows_of_draw_; ++state) {
        check_tries(state, result.rows.rows());
        if (state == states_.size()) {
            states_.emplace_back(W_, state + 1);
        }
        if (const auto row = states_[state].combined_row(evaluator_, result.constants)) {
            result.rows.append(*row);
        }
    }
    return result;
}

std::vector<std::vector<std::size_t>> regrouping::constants_of(const std::vector<int>& joints) const {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < tree_.constants.size(); ++i) {
        const kinematic_constant& constant = tree_.constants[i];
        const GiNaC::symbol& symbol = tree_.constants[constant.is_sine ? i - 1 : i].symbol;
        const bool enters_any = std::any_of(joints.begin(), joints.end(), [this, &symbol](int joint) {
            return enters(symbol, tree_.joints[static_cast<std::size_t>(joint)]);
        });
        if (enters_any && constant.is_sine) {
            groups.back().push_back(i);
        } else if (enters_any) {
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

regrouping::link_relation regrouping::relation_of(int link) const {
    link_relation relation;
    relation.columns = columns_of(own_.kept, link);
    std::vector<int> joints;
    std::vector<std::size_t> inner;
    for (int at = link; at >= 0 && inner.empty();) {
        joints.push_back(at);
        at = tree_.joints[static_cast<std::size_t>(at)].antecedent;
        inner = inertial(columns_of(positions(W_.columns), at));
    }
    relation.columns.insert(relation.columns.end(), inner.begin(), inner.end());
    relation.groups = constants_of(joints);
    relation.first_target = relation.columns.size();
    const std::vector<std::size_t> targets = columns_of(own_.dropped, link);
    relation.columns.insert(relation.columns.end(), targets.begin(), targets.end());
    return relation;
}

regrouping::formula_table regrouping::solve(const link_relation& relation, std::size_t variants,
                                            std::vector<constants_draw>& draws) {
    const std::vector<monomial> monomials = candidate_monomials(relation.groups);
    const std::size_t count = monomials.size() + spare_draws;
    while (draws.size() < count * variants) {
        draws.push_back(draw(draws.size() / variants, relation.groups, draws.size() % variants));
    }
    exact_selection first;
    std::size_t targets = 0;
    std::optional<field_matrix> samples;
    for (std::size_t s = 0; s < count; ++s) {
        field_matrix rows(relation.columns.size());
        for (std::size_t v = 0; v < variants; ++v) {
            append_columns(draws[s * variants + v].rows, relation.columns, relation.columns.size() + spare_rows, rows);
        }
        const exact_selection elimination = select_exactly(std::move(rows), positions(relation.columns.size()));
        if (s == 0) {
            first = elimination;
            targets = static_cast<std::size_t>(
                std::count_if(first.dropped.begin(), first.dropped.end(),
                              [&relation](std::size_t c) { return c >= relation.first_target; }));
            samples.emplace(monomials.size() + first.kept.size() * targets);
        }
        const bool depends = !first.kept.empty() && first.kept.back() < relation.first_target;
        if (!depends || elimination.kept != first.kept || elimination.dropped != first.dropped) {
            return {};
        }
        std::vector<prime_field> row = values_of(monomials, draws[s * variants].constants);
        for (const std::vector<prime_field>& coefficients : elimination.beta) {
            row.insert(row.end(), coefficients.end() - static_cast<std::ptrdiff_t>(targets), coefficients.end());
        }
        samples->append(row);
    }
    const std::vector<constant_polynomial> found = fit(monomials, *samples);
    formula_table table;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t target = first.dropped[first.dropped.size() - targets + i % targets];
        table[relation.columns[target]][relation.columns[first.kept[i / targets]]] = found[i];
    }
    return table;
}

void regrouping::insert(const formula_table& relations, formula_table& table) const {
    for (const auto& [dropped, combination] : relations) {
        auto& row = table[dropped];
        for (const auto& [p, coefficient] : combination) {
            if (is_kept_[p]) {
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

regrouping::formula_table regrouping::formulas() {
    std::vector<link_relation> relations;
    for (std::size_t link = 0; link < tree_.joints.size(); ++link) {
        link_relation relation = relation_of(static_cast<int>(link));
        rows_of_draw_ = std::max(rows_of_draw_, relation.columns.size() + spare_rows);
        if (relation.columns.size() > relation.first_target) {
            relations.push_back(std::move(relation));
        }
    }
    std::vector<constants_draw> shared;
    formula_table table;
    for (const link_relation& relation : relations) {
        formula_table found = solve(relation, 1, shared);
        if (found.empty()) {
            std::vector<constants_draw> own;
            found = solve(relation, 3, own);
        }
        insert(found, table);
    }
    return table;
}

std::optional<regrouped_column> regrouping::formula(const formula_table& table, std::size_t k, std::size_t d) const {
    const auto row = table.find(own_.dropped[d]);
    if (row == table.end()) {
        return std::nullopt;
    }
    regrouped_column result;
    result.kept = own_.kept[k];
    result.dropped = own_.dropped[d];
    if (const auto entry = row->second.find(result.kept); entry != row->second.end()) {
        result.coefficient = entry->second;
    }
    result.exact = result.coefficient.value(own_constants_);
    const bool holds = is_short(result.coefficient) && to_field(result.exact) == own_.beta[k][d];
    return holds ? std::optional(result) : std::nullopt;
}

regrouped_column regrouping::number(std::size_t k, std::size_t d, double by_qr) const {
    bool found = true;
    const rational fraction = reconstruct(own_.beta[k][d], found);
    regrouped_column result;
    result.kept = own_.kept[k];
    result.dropped = own_.dropped[d];
    result.is_exact = found && std::abs(to_double(fraction) - by_qr) < 1e-9 * std::max(1.0, std::abs(by_qr));
    result.exact = result.is_exact ? fraction : cln::rational(cln::cl_DF(by_qr));
    result.coefficient = constant_polynomial(result.exact);
    return result;
}

std::vector<regrouped_column> regrouping::columns(const Eigen::MatrixXd& sampled) {
    const formula_table table = formulas();
    std::optional<Eigen::MatrixXd> by_qr;
    std::vector<regrouped_column> result;
    for (std::size_t k = 0; k < own_.kept.size(); ++k) {
        for (std::size_t d = 0; d < own_.dropped.size(); ++d) {
            if (own_.beta[k][d].is_zero()) {
                continue;
            }
            if (const auto found = formula(table, k, d)) {
                result.push_back(*found);
                continue;
            }
            if (!by_qr) {
                by_qr = express_by_qr(sampled, own_.kept, own_.dropped);
            }
            result.push_back(number(k, d, (*by_qr)(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d))));
        }
    }
    return result;
}

int regrouping::prove(const std::vector<regrouped_column>& columns) const {
    if (W_.has_roots) {
        return static_cast<int>(own_.dropped.size());
    }
    std::vector<std::size_t> exact = own_.dropped;
    for (const regrouped_column& column : columns) {
        if (!column.is_exact) {
            exact.erase(std::remove(exact.begin(), exact.end(), column.dropped), exact.end());
        }
    }
    graph_evaluator<rational> evaluator(W_.graph, [](const rational& value) { return value; });
    for (int s = 0; s < points_; ++s) {
        sample_point<rational> point(W_, static_cast<std::uint64_t>(s) + 1);
        std::vector<rational> row = *point.combined_row(evaluator, own_constants_);
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
    return static_cast<int>(own_.dropped.size() - exact.size());
}

}  // namespace idim::generator
