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

/// What stands at the root of an expression.
enum class shape { symbol, product, sum, number, power, function, pi };

/// GiNaC's own tests of a type compare names; what describes a class stands at one address.
shape shape_of(const ex& e) {
    const GiNaC::registered_class_info* const found = &GiNaC::ex_to<GiNaC::basic>(e).get_class_info();
    const std::pair<const GiNaC::registered_class_info*, shape> known[] = {
        {&GiNaC::symbol::get_class_info_static(), shape::symbol},
        {&GiNaC::mul::get_class_info_static(), shape::product},
        {&GiNaC::numeric::get_class_info_static(), shape::number},
        {&GiNaC::add::get_class_info_static(), shape::sum},
        {&GiNaC::power::get_class_info_static(), shape::power},
        {&GiNaC::function::get_class_info_static(), shape::function},
        {&GiNaC::constant::get_class_info_static(), shape::pi},
    };
    for (const auto& [info, what] : known) {
        if (info == found) {
            return what;
        }
    }
    throw std::logic_error("unexpected expression in a model");
}

/// An expression with its operands in order. As an operand it has the text that it is sorted by, which is built from
/// declared symbol indices and sorted operands, so that it is the same whatever order GiNaC holds the operands in.
struct ordered {
    ex value;
    shape root;
    std::string key;
    std::vector<ordered> operands;  ///< of a sum, product or function; a function's as they are
};

rational to_rational(const ex& number) {
    const auto& value = GiNaC::ex_to<GiNaC::numeric>(number);
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
        ordered result{e, shape_of(e), {}, {}};
        if (result.root == shape::product || result.root == shape::sum || result.root == shape::function) {
            result.operands.reserve(e.nops());
            for (const ex& operand : e) {
                result.operands.push_back(with_key(operand));
            }
            std::sort(result.operands.begin(), result.operands.end(),
                      [](const ordered& a, const ordered& b) { return a.key < b.key; });
        }
        return result;
    }

    ordered with_key(const ex& e) const {
        ordered result = in_order(e);
        result.key = key_of(result);
        return result;
    }

    std::string key_of(const ordered& term) const {
        switch (term.root) {
            case shape::symbol:
                return symbols_.at(term.value).key;
            case shape::number:
                return "~" + to_fraction(to_rational(term.value));
            case shape::pi:
                return "~pi";
            case shape::power:
                return with_key(term.value.op(0)).key + "^" + with_key(term.value.op(1)).key;
            case shape::product:
                return joined_keys(term.operands, "*");
            case shape::sum:
                return "a" + joined_keys(term.operands, ",") + ")";
            case shape::function:
                break;
        }
        return "f" + std::string(to_string(kind_of(term.value))) + joined_keys(term.operands, ",") + ")";
    }

    static std::string joined_keys(const std::vector<ordered>& operands, const char* separator) {
        std::string keys;
        for (const ordered& operand : operands) {
            keys.append(operand.key).append(separator);
        }
        return keys;
    }

    signed_node build(const ex& e) { return build(in_order(e)); }

    signed_node build(const ordered& term) {
        const ex& e = term.value;
        switch (term.root) {
            case shape::symbol:
                return symbols_.at(e).value;
            case shape::number:
                return graph_.constant(to_rational(e));
            case shape::pi:
                return graph_.constant(to_rational(constant_value(e, {})));
            case shape::power:
                return build_power(e.op(0), e.op(1));
            case shape::sum:
                return build_sum(term);
            case shape::product:
                return build_product(term);
            case shape::function:
                break;
        }
        const signed_node argument = build(e.op(0).expand());
        return graph_.function(kind_of(e), argument);
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
            if (is_reciprocal(operand)) {
                const signed_node factor = build_power(operand.value.op(0), -operand.value.op(1));
                divisor = graph_.multiply(divisor, factor);
            } else {
                const signed_node factor = build(operand);
                product = graph_.multiply(product, factor);
            }
        }
        return divisor == one ? product : graph_.divide(product, divisor);
    }

    static bool is_reciprocal(const ordered& factor) {
        return factor.root == shape::power && shape_of(factor.value.op(1)) == shape::number &&
               GiNaC::ex_to<GiNaC::numeric>(factor.value.op(1)).is_negative();
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
