#include "graph/derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "graph/evaluate.hpp"
#include "graph/operation_count.hpp"

namespace idim::generator {

namespace {

using unary = std::function<signed_node(expression_graph&, signed_node, signed_node)>;

std::vector<double> values(const expression_graph& graph, double x, double y) {
    std::vector<double> at;
    for (const graph_symbol& leaf : graph.symbols()) {
        at.push_back(leaf.name == "x" ? x : y);
    }
    double_arithmetic arithmetic;
    return evaluate(graph, at, arithmetic);
}

expression_graph graph_of(const unary& f) {
    expression_graph graph;
    const signed_node x = graph.symbol({"x", symbol_role::position, 0});
    const signed_node y = graph.symbol({"y", symbol_role::velocity, 0});
    graph.output("f", 0, f(graph, x, y));
    return graph;
}

expression_graph gradient_of(const expression_graph& graph) {
    return differentiate(graph, {{"by_x", symbol_role::position, 1}, {"by_y", symbol_role::velocity, 1}});
}

/// Differences of fourth order: of steps of 1e-3 their error is about 1e-12 times the fifth derivative.
double difference(const std::function<double(double)>& f) {
    const double h = 1e-3;
    return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
}

unary function(function_kind kind) {
    return [kind](expression_graph& g, signed_node x, signed_node y) {
        const signed_node inner = g.add(g.multiply(x, y), -g.constant(rational(1) / rational(4)));
        return g.function(kind, -(-inner));
    };
}

}  // namespace

TEST(Derivatives, OfEveryOperationAreThoseOfDifferences) {
    std::vector<unary> cases = {
        [](auto& g, auto x, auto y) { return g.add(x, -y); },
        [](auto& g, auto x, auto y) { return g.subtract(-g.multiply(x, -y), x); },
        [](auto& g, auto x, auto y) { return g.divide(x, g.add(y, g.one())); },
        [](auto& g, auto x, auto y) { return g.divide(g.one(), -g.add(x, y)); },
        [](auto& g, auto x, auto y) { return g.multiply(g.power(g.add(x, -y), 5), y); },
        [](auto& g, auto x, auto y) { return g.function_pow(x, -g.add(y, g.constant(rational(1) / rational(3)))); },
        [](auto& g, auto x, auto) { return g.function_pow(x, g.constant(rational(5) / rational(2))); },
    };
    for (const function_kind kind :
         {function_kind::sin, function_kind::cos, function_kind::tan, function_kind::exp, function_kind::log,
          function_kind::sqrt, function_kind::abs, function_kind::tanh, function_kind::atan}) {
        cases.push_back(function(kind));
    }
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const expression_graph graph = graph_of(cases[k]);
        const double x = 0.8, y = 1.3;
        const std::vector<double> found = values(gradient_of(graph), x, y);
        const auto f = [&](double u, double v) { return values(graph, u, v)[0]; };
        const double expected[] = {difference([&](double h) { return f(x + h, y); }),
                                   difference([&](double h) { return f(x, y + h); })};
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(found[i], expected[i], 1e-9 * (1.0 + std::abs(expected[i]))) << "case " << k;
        }
    }
}

TEST(Derivatives, OfSignIsZeroAndOfAbsIsSign) {
    const expression_graph sign = graph_of([](auto& g, auto, auto y) { return g.function(function_kind::sign, y); });
    const expression_graph abs = graph_of([](auto& g, auto, auto y) { return g.function(function_kind::abs, -y); });
    for (const double y : {-2.0, 0.0, 3.0}) {
        EXPECT_EQ(values(gradient_of(sign), 1.0, y), (std::vector<double>{0.0, 0.0}));
        EXPECT_EQ(values(gradient_of(abs), 1.0, y), (std::vector<double>{0.0, y == 0.0 ? 0.0 : y / std::abs(y)}));
    }
}

TEST(Derivatives, OfWhatDoesNotVaryTakeNoOperations) {
    const expression_graph graph = graph_of([](auto& g, auto, auto) {
        return g.function(function_kind::log, g.symbol({"p", symbol_role::parameter, 0}));
    });
    const operation_count count = count_operations(gradient_of(graph));
    EXPECT_EQ(count.mul + count.add + count.div + count.functions, 0);
}

TEST(Derivatives, TakeTheOrderWithFewerOperations) {
    // One output of many leaves: a sweep inwards gives all of them. A chain of products of k + 1 factors, whose
    // derivatives outwards would take k sweeps of growing length.
    expression_graph graph;
    constexpr int leaves = 12;
    signed_node product = graph.one();
    for (int k = 0; k < leaves; ++k) {
        const std::string number = std::to_string(k);
        const signed_node leaf = graph.symbol({"q" + number, symbol_role::position, k});
        product = graph.function(function_kind::sin, graph.multiply(product, leaf));
    }
    graph.output("f", 0, product);
    const operation_count count = count_operations(differentiate(graph, {{"by_q", symbol_role::position, leaves}}));
    EXPECT_LE(count.mul, 4 * leaves);  // inwards: the product, and up to three for each leaf
}

}  // namespace idim::generator
