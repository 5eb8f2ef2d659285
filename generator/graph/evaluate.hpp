#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Values of the outputs of a graph over any number type T, many times over: the nodes that some output needs are
/// looked up once, each with a place of its own for its value, and constants are put in their places once.
template <class T>
class graph_evaluator {
  public:
    /// `number` gives T from a rational.
    template <class Number>
    graph_evaluator(const expression_graph& graph, const Number& number) {
        const std::vector<bool> live = graph.live();
        std::vector<std::size_t> place(live.size(), 0);
        for (std::size_t id = 0; id < live.size(); ++id) {
            if (!live[id]) {
                continue;
            }
            const graph_node& node = graph.nodes()[id];
            place[id] = values_.size();
            values_.push_back(node.kind == operation::constant ? number(node.value) : T());
            if (node.kind == operation::symbol) {
                symbols_.emplace_back(place[id], static_cast<std::size_t>(node.symbol));
            } else if (node.kind != operation::constant) {
                const bool has_second = node.kind != operation::function || node.function == function_kind::pow;
                const std::size_t a = place[static_cast<std::size_t>(node.a.id)];
                const std::size_t b = has_second ? place[static_cast<std::size_t>(node.b.id)] : a;
                steps_.push_back({node.kind, node.function, node.a, node.b.negative, place[id], a, b});
            }
        }
        for (const graph_output& out : graph.outputs()) {
            outputs_.emplace_back(place[static_cast<std::size_t>(out.value.id)], out.value.negative);
        }
    }

    /// Values of the outputs, in the order of graph.outputs().
    ///  - symbol_values: one T per entry of graph.symbols(), same order
    ///  - functions: `functions.function(kind, argument node, argument value, second value)` gives a T.
    template <class Functions>
    std::vector<T> evaluate(const std::vector<T>& symbol_values, Functions& functions) {
        for (const auto& [place, symbol] : symbols_) {
            values_[place] = symbol_values[symbol];
        }
        for (const step& s : steps_) {
            values_[s.place] = result(s, functions);
        }
        std::vector<T> result;
        result.reserve(outputs_.size());
        for (const auto& [place, negative] : outputs_) {
            result.push_back(negative ? T(-values_[place]) : values_[place]);
        }
        return result;
    }

    /// Operations and functions carried out by one evaluation.
    std::size_t size() const { return steps_.size(); }

  private:
    struct step {
        operation kind;
        function_kind function;
        signed_node argument;  ///< first operand, as the graph has it; negative for functions only
        bool subtract;         ///< or a negative second argument of a function
        std::size_t place, a, b;
    };

    template <class Functions>
    T result(const step& s, Functions& functions) const {
        const T& a = values_[s.a];
        const T& b = values_[s.b];
        switch (s.kind) {
            case operation::add:
                return s.subtract ? a - b : a + b;
            case operation::multiply:
                return a * b;
            case operation::divide:
                return a / b;
            default:
                return functions.function(s.function, s.argument, s.argument.negative ? T(-a) : a,
                                          s.subtract ? T(-b) : b);
        }
    }

    std::vector<T> values_;
    std::vector<step> steps_;
    std::vector<std::pair<std::size_t, std::size_t>> symbols_;  ///< place, index of the symbol
    std::vector<std::pair<std::size_t, bool>> outputs_;         ///< place, negative
};

/// Values of the outputs of a graph, once. `arithmetic` gives numbers by `arithmetic.number(r)` and functions as above.
template <class T, class Arithmetic>
std::vector<T> evaluate(const expression_graph& graph, const std::vector<T>& symbol_values, Arithmetic& arithmetic) {
    graph_evaluator<T> evaluator(graph, [&arithmetic](const rational& value) { return arithmetic.number(value); });
    return evaluator.evaluate(symbol_values, arithmetic);
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
