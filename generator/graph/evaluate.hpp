#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Values of all live nodes of a graph over any number type T.
///  - symbol_values: one T per entry of graph.symbols(), same order
///  - arithmetic: gives T from a rational as `arithmetic.number(r)` and functions as
///    `arithmetic.function(kind, argument node, argument value, second value)`.
/// The result is indexed by node id; dead nodes hold a default T.
template <class T, class Arithmetic>
std::vector<T> evaluate_nodes(const expression_graph& graph, const std::vector<T>& symbol_values,
                              Arithmetic& arithmetic) {
    const std::vector<bool> live = graph.live();
    std::vector<T> value(graph.nodes().size());
    const auto of = [&value](signed_node n) {
        const T& v = value[static_cast<std::size_t>(n.id)];
        return n.negative ? T(-v) : v;
    };
    for (std::size_t id = 0; id < value.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (!live[id]) {
            continue;
        }
        switch (node.kind) {
            case operation::constant:
                value[id] = arithmetic.number(node.value);
                break;
            case operation::symbol:
                value[id] = symbol_values[static_cast<std::size_t>(node.symbol)];
                break;
            case operation::add:
                value[id] = of(node.a) + of(node.b);
                break;
            case operation::multiply:
                value[id] = of(node.a) * of(node.b);
                break;
            case operation::divide:
                value[id] = of(node.a) / of(node.b);
                break;
            case operation::function:
                value[id] = arithmetic.function(node.function, node.a, of(node.a),
                                                node.function == function_kind::pow ? of(node.b) : T());
                break;
        }
    }
    return value;
}

/// Values of the outputs, in the order of graph.outputs().
template <class T, class Arithmetic>
std::vector<T> evaluate(const expression_graph& graph, const std::vector<T>& symbol_values, Arithmetic& arithmetic) {
    const std::vector<T> value = evaluate_nodes(graph, symbol_values, arithmetic);
    std::vector<T> result;
    result.reserve(graph.outputs().size());
    for (const graph_output& out : graph.outputs()) {
        const T& v = value[static_cast<std::size_t>(out.value.id)];
        result.push_back(out.value.negative ? T(-v) : v);
    }
    return result;
}

/// Plain floating point, for evaluate().
struct double_arithmetic {
    static double number(const rational& value) { return to_double(value); }
    static double function(function_kind kind, signed_node, double x, double y) {
        switch (kind) {
            case function_kind::sin:
                return std::sin(x);
            case function_kind::cos:
                return std::cos(x);
            case function_kind::tan:
                return std::tan(x);
            case function_kind::exp:
                return std::exp(x);
            case function_kind::log:
                return std::log(x);
            case function_kind::sqrt:
                return std::sqrt(x);
            case function_kind::abs:
                return std::abs(x);
            case function_kind::sign:
                return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0);
            case function_kind::tanh:
                return std::tanh(x);
            case function_kind::atan:
                return std::atan(x);
            case function_kind::pow:
                return std::pow(x, y);
            case function_kind::none:
                break;
        }
        throw std::logic_error("not a function");
    }
};

}  // namespace idim::generator
