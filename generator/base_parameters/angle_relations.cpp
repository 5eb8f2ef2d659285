#include "base_parameters/angle_relations.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <algorithm>

namespace idim::generator {

namespace {

/// Beyond this multiple of an angle the relation is left out: cosines of q and of q/100 behave as if they were
/// independent, and exact values would grow long.
constexpr int largest_multiple = 12;

/// sum of coefficient * symbol + constant
struct linear_form {
    std::map<int, rational> coefficients;  ///< none of them zero
    rational constant = 0;

    void add(const rational& factor, const linear_form& other) {
        for (const auto& [symbol, coefficient] : other.coefficients) {
            rational& sum = coefficients.try_emplace(symbol, rational(0)).first->second;
            sum = sum + factor * coefficient;
            if (cln::zerop(sum)) {
                coefficients.erase(symbol);
            }
        }
        constant = constant + factor * other.constant;
    }
};

class form_reader {
  public:
    form_reader(const expression_graph& graph, const std::vector<rational>& constants)
        : graph_(graph), constants_(constants) {}

    /// Nothing where the value is not linear in the symbols.
    std::optional<linear_form> read(signed_node value) const {
        const graph_node& node = graph_[value];
        std::optional<linear_form> form;
        switch (node.kind) {
            case operation::constant:
                form = linear_form{{}, node.value};
                break;
            case operation::symbol:
                form = symbol(node.symbol);
                break;
            case operation::add:
                form = sum(read(node.a), read(node.b));
                break;
            case operation::multiply:
                form = product(read(node.a), read(node.b));
                break;
            case operation::divide:
                form = quotient(read(node.a), read(node.b));
                break;
            case operation::function:
                break;
        }
        return value.negative && form ? scaled(*form, -1) : form;
    }

  private:
    static linear_form scaled(const linear_form& form, const rational& factor) {
        linear_form result;
        result.add(factor, form);
        return result;
    }

    linear_form symbol(int number) const {
        const graph_symbol& leaf = graph_.symbols()[static_cast<std::size_t>(number)];
        if (leaf.role == symbol_role::constant) {
            return {{}, constants_[static_cast<std::size_t>(leaf.index)]};
        }
        return {{{number, rational(1)}}, rational(0)};
    }

    static std::optional<linear_form> sum(std::optional<linear_form> a, const std::optional<linear_form>& b) {
        if (!a || !b) {
            return std::nullopt;
        }
        a->add(1, *b);
        return a;
    }

    static std::optional<linear_form> product(const std::optional<linear_form>& a,
                                              const std::optional<linear_form>& b) {
        if (!a || !b || (!a->coefficients.empty() && !b->coefficients.empty())) {
            return std::nullopt;
        }
        return a->coefficients.empty() ? scaled(*b, a->constant) : scaled(*a, b->constant);
    }

    static std::optional<linear_form> quotient(const std::optional<linear_form>& a,
                                               const std::optional<linear_form>& b) {
        if (!a || !b || !b->coefficients.empty()) {
            return std::nullopt;
        }
        return scaled(*a, 1 / b->constant);
    }

    const expression_graph& graph_;
    const std::vector<rational>& constants_;
};

struct coordinate_angle {
    int node = 0;
    linear_form form;
};

/// An angle as a sum of rational multiples of others (by their place among the free ones) and a constant.
struct dependent_angle {
    int node = 0;
    std::map<std::size_t, rational> multiples;
    rational constant = 0;
};

std::vector<coordinate_angle> angles_of(const expression_graph& graph, const form_reader& reader) {
    std::map<int, coordinate_angle> found;
    for (const graph_node& node : graph.nodes()) {
        const bool turns = node.kind == operation::function &&
                           (node.function == function_kind::cos || node.function == function_kind::sin);
        if (!turns) {
            continue;
        }
        if (auto form = reader.read({node.a.id, false}); form && !form->coefficients.empty()) {
            found[node.a.id] = {node.a.id, *form};
        }
    }
    std::vector<coordinate_angle> result;
    for (const auto& [node, one] : found) {
        result.push_back(one);
    }
    return result;
}

/// Forms by their leading symbol, each with the multiples of free angles that it is: elimination one form at a time.
class echelon {
  public:
    /// The angle in terms of the free ones before it, or nothing, and then it is free itself.
    std::optional<dependent_angle> insert(const coordinate_angle& one) {
        linear_form rest = one.form;
        dependent_angle result;
        result.node = one.node;
        for (const auto& [leading, row] : rows_) {
            const auto at = rest.coefficients.find(leading);
            if (at == rest.coefficients.end()) {
                continue;
            }
            const rational factor = at->second / row.form.coefficients.at(leading);
            rest.add(-factor, row.form);
            for (const auto& [free, multiple] : row.multiples) {
                rational& sum = result.multiples.try_emplace(free, rational(0)).first->second;
                sum = sum + factor * multiple;
            }
        }
        if (rest.coefficients.empty()) {
            result.constant = rest.constant;
            return result;
        }
        for (auto& [free, multiple] : result.multiples) {
            multiple = -multiple;
        }
        result.multiples[free_++] = 1;
        rows_[rest.coefficients.begin()->first] = {rest, result.multiples};
        return std::nullopt;
    }

  private:
    struct echelon_row {
        linear_form form;
        std::map<std::size_t, rational> multiples;
    };
    std::map<int, echelon_row> rows_;
    std::size_t free_ = 0;
};

/// Cosine and sine, on the unit circle exactly: from the tangent of half the angle to 60 digits.
std::pair<rational, rational> circle_point(const rational& angle) {
    const rational t = cln::rational(cln::tan(cln::cl_float(angle / 2, cln::float_format(60))));
    const rational norm = 1 + t * t;
    return {(1 - t * t) / norm, 2 * t / norm};
}

bool is_small(const rational& multiple) {
    return cln::denominator(multiple) == 1 && cln::abs(multiple) <= largest_multiple;
}

int to_int(const rational& integer) {
    return cln::cl_I_to_int(cln::numerator(integer));
}

}  // namespace

angle_relations::angle_relations(const expression_graph& graph, const std::vector<rational>& constants) {
    echelon rows;
    std::vector<int> free;
    std::vector<dependent_angle> dependent;
    for (const coordinate_angle& one : angles_of(graph, form_reader(graph, constants))) {
        if (auto relation = rows.insert(one)) {
            dependent.push_back(*relation);
        } else {
            free.push_back(one.node);
        }
    }
    // The free angles are cut so fine that all others are integer multiples.
    std::vector<cln::cl_I> parts(free.size(), 1);
    for (const dependent_angle& one : dependent) {
        std::vector<cln::cl_I> finer = parts;
        for (const auto& [at, multiple] : one.multiples) {
            finer[at] = cln::lcm(parts[at], cln::denominator(multiple));
        }
        const bool usable = std::all_of(one.multiples.begin(), one.multiples.end(), [&finer](const auto& term) {
            return is_small(finer[term.first]) && is_small(term.second * finer[term.first]);
        });
        if (usable) {
            parts = finer;
            composed_[one.node] = {};
        }
    }
    for (std::size_t at = 0; at < free.size(); ++at) {
        if (parts[at] != 1) {
            composed_[free[at]] = {{{free[at], to_int(parts[at])}}, std::nullopt};
        }
    }
    for (const dependent_angle& one : dependent) {
        const auto composed = composed_.find(one.node);
        if (composed == composed_.end()) {
            continue;
        }
        for (const auto& [at, multiple] : one.multiples) {
            if (!cln::zerop(multiple)) {
                composed->second.terms.emplace_back(free[at], to_int(multiple * parts[at]));
            }
        }
        if (!cln::zerop(one.constant)) {
            composed->second.constant = circle_point(one.constant);
        }
    }
}

}  // namespace idim::generator
