#include <cln/rational.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <unordered_map>

#include "dynamics/symbolic_model.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// An expression with the text it is sorted by. The text is built from declared symbol indices and sorted operands, so
/// it is the same whatever order GiNaC holds the operands in.
struct ordered {
    ex value;
    std::string key;
    std::vector<ordered> operands;  ///< of a sum or product, sorted
    signed_node node;               ///< of a symbol
};

rational to_rational(const ex& number) {
    const auto value = GiNaC::ex_to<GiNaC::numeric>(number);
    if (!value.is_rational()) {
        throw std::logic_error("a number in a model is not rational");
    }
    return cln::the<cln::cl_RA>(value.to_cl_N());
}

function_kind kind_of(const ex& function) {
    static const std::map<std::string, function_kind> kinds = {
        {"sin", function_kind::sin},   {"cos", function_kind::cos},   {"tan", function_kind::tan},
        {"exp", function_kind::exp},   {"log", function_kind::log},   {"abs", function_kind::abs},
        {"sign", function_kind::sign}, {"tanh", function_kind::tanh}, {"atan", function_kind::atan},
    };
    return kinds.at(GiNaC::ex_to<GiNaC::function>(function).get_name());
}

class graph_builder {
  public:
    graph_builder(const symbolic_model& model, constants_as constants) {
        // About three operations to an assignment.
        graph_.reserve(model.leaves().size() + 3 * model.assignments().size());
        symbols_.reserve(model.leaves().size() + model.assignments().size());
        for (const symbolic_leaf& leaf : model.leaves()) {
            const bool fold = leaf.value && constants == constants_as::values;
            add_symbol(leaf.symbol, fold ? graph_.constant(*leaf.value) : graph_.symbol(leaf.declared));
        }
        for (const assignment& step : model.assignments()) {
            const signed_node value = build(step.body);
            // A node holds a value without its sign: "n" behind a name says that it is minus that quantity.
            graph_.name(value, step.symbol.get_name() + (value.negative ? "n" : ""));
            add_symbol(step.symbol, value);
        }
        for (const symbolic_output& out : model.outputs()) {
            graph_.output(out.array, out.index, build(out.value.expand()));
        }
    }

    expression_graph take() { return std::move(graph_); }

  private:
    void add_symbol(const GiNaC::symbol& symbol, signed_node value) {
        const std::size_t index = symbols_.size();
        symbols_[symbol] = {fmt::format("{:06}", index), value};
    }

    ordered in_order(const ex& e) const {
        ordered result{e, {}, {}, {}};
        if (GiNaC::is_exactly_a<GiNaC::symbol>(e)) {
            const known_symbol& symbol = symbols_.at(e);
            result.key = symbol.key;
            result.node = symbol.value;
        } else if (GiNaC::is_exactly_a<GiNaC::numeric>(e)) {
            result.key = "~" + to_fraction(to_rational(e));
        } else if (GiNaC::is_exactly_a<GiNaC::constant>(e)) {
            result.key = "~pi";
        } else if (GiNaC::is_exactly_a<GiNaC::power>(e)) {
            result.key = in_order(e.op(0)).key + "^" + in_order(e.op(1)).key;
        } else if (GiNaC::is_exactly_a<GiNaC::mul>(e)) {
            sort_operands(result, "*");
        } else if (GiNaC::is_exactly_a<GiNaC::add>(e)) {
            result.key = "a";
            sort_operands(result, ",");
            result.key += ")";
        } else if (GiNaC::is_exactly_a<GiNaC::function>(e)) {
            result.key = "f" + std::string(to_string(kind_of(e)));
            sort_operands(result, ",");
            result.key += ")";
        } else {
            throw std::logic_error("unexpected expression in a model");
        }
        return result;
    }

    void sort_operands(ordered& of, const char* separator) const {
        of.operands.reserve(of.value.nops());
        for (const ex& operand : of.value) {
            of.operands.push_back(in_order(operand));
        }
        std::stable_sort(of.operands.begin(), of.operands.end(),
                         [](const ordered& a, const ordered& b) { return a.key < b.key; });
        for (const ordered& operand : of.operands) {
            of.key.append(operand.key).append(separator);
        }
    }

    signed_node build(const ex& e) { return build(in_order(e)); }

    signed_node build(const ordered& term) {
        const ex& e = term.value;
        if (GiNaC::is_exactly_a<GiNaC::symbol>(e)) {
            return term.node;
        }
        if (GiNaC::is_exactly_a<GiNaC::numeric>(e)) {
            return graph_.constant(to_rational(e));
        }
        if (GiNaC::is_exactly_a<GiNaC::constant>(e)) {
            return graph_.constant(to_rational(constant_value(e, {})));
        }
        if (GiNaC::is_exactly_a<GiNaC::power>(e)) {
            return build_power(e.op(0), e.op(1));
        }
        if (GiNaC::is_exactly_a<GiNaC::function>(e)) {
            const signed_node argument = build(e.op(0).expand());
            return graph_.function(kind_of(e), argument);
        }
        return GiNaC::is_exactly_a<GiNaC::add>(e) ? build_sum(term) : build_product(term);
    }

    signed_node build_sum(const ordered& sum_of) {
        signed_node sum = graph_.zero();
        for (const ordered& operand : sum_of.operands) {
            const signed_node term = build(operand);
            sum = graph_.add(sum, term);
        }
        return sum;
    }

    signed_node build_product(const ordered& product_of) {
        const signed_node one = graph_.one();
        signed_node product = one;
        signed_node divisor = one;
        for (const ordered& operand : product_of.operands) {
            if (is_reciprocal(operand.value)) {
                const signed_node factor = build_power(operand.value.op(0), -operand.value.op(1));
                divisor = graph_.multiply(divisor, factor);
            } else {
                const signed_node factor = build(operand);
                product = graph_.multiply(product, factor);
            }
        }
        return divisor == one ? product : graph_.divide(product, divisor);
    }

    static bool is_reciprocal(const ex& e) {
        return GiNaC::is_a<GiNaC::power>(e) && GiNaC::is_a<GiNaC::numeric>(e.op(1)) &&
               GiNaC::ex_to<GiNaC::numeric>(e.op(1)).is_negative();
    }

    signed_node build_power(const ex& base, const ex& exponent) {
        if (GiNaC::is_a<GiNaC::numeric>(exponent) && GiNaC::ex_to<GiNaC::numeric>(exponent).is_integer()) {
            return integer_power(base, GiNaC::ex_to<GiNaC::numeric>(exponent).to_int());
        }
        const signed_node b = build(base.expand());
        if (exponent.is_equal(GiNaC::numeric(1, 2))) {
            return graph_.function(function_kind::sqrt, b);
        }
        const signed_node x = build(exponent.expand());
        return graph_.function_pow(b, x);
    }

    /// GiNaC scales a sum under a power so that its first term, first in an order that changes from run to run, has
    /// coefficient one. Scaling it by the coefficient of the term that is first in our order undoes that.
    signed_node integer_power(const ex& base, int exponent) {
        const ex expanded = base.expand();
        if (!GiNaC::is_a<GiNaC::add>(expanded)) {
            const signed_node b = build(expanded);
            return graph_.power(b, exponent);
        }
        const ex first = in_order(expanded).operands.front().value;
        const ex factor = GiNaC::is_a<GiNaC::mul>(first) && GiNaC::is_a<GiNaC::numeric>(first.op(first.nops() - 1))
                              ? first.op(first.nops() - 1)
                              : ex(1);
        const signed_node b = build((expanded / factor).expand());
        const signed_node scale = graph_.power(build(factor), exponent);
        return graph_.multiply(scale, graph_.power(b, exponent));
    }

    struct known_symbol {
        std::string key;
        signed_node value;
    };

    expression_graph graph_;
    std::unordered_map<ex, known_symbol> symbols_;
};

}  // namespace

expression_graph build_graph(const symbolic_model& model, constants_as constants) {
    expression_graph graph = graph_builder(model, constants).take();
    graph.assert_invariants();
    return graph;
}

}  // namespace idim::generator
