#include <gtest/gtest.h>

#include "graph/evaluate.hpp"

namespace idim::generator {

namespace {

/// y1 = cos(-x) (x - 3), y2 = -x / y, with a node that nothing needs.
expression_graph sample() {
    expression_graph graph;
    const signed_node x = graph.symbol({"x", symbol_role::position, 0});
    const signed_node y = graph.symbol({"y", symbol_role::velocity, 0});
    graph.multiply(x, y);
    const signed_node cosine = graph.function(function_kind::cos, -x);
    graph.output("y", 0, graph.multiply(cosine, graph.subtract(x, graph.constant(3))));
    graph.output("y", 1, -graph.divide(x, y));
    return graph;
}

}  // namespace

TEST(GraphEvaluator, GivesTheOutputsForEverySetOfValues) {
    const expression_graph graph = sample();
    graph_evaluator<double> evaluator(graph, double_arithmetic::number);
    double_arithmetic functions;
    for (const double x : {0.5, -2.0, 3.0}) {
        for (const double y : {0.25, -1.0}) {
            const std::vector<double> found = evaluator.evaluate({x, y}, functions);
            ASSERT_EQ(found.size(), 2u);
            EXPECT_EQ(found[0], std::cos(x) * (x - 3.0));
            EXPECT_EQ(found[1], -(x / y));
        }
    }
}

TEST(GraphEvaluator, CarriesOutWhatSomeOutputNeeds) {
    EXPECT_EQ(graph_evaluator<double>(sample(), double_arithmetic::number).size(), 4u);  // cos, -, *, /
}

}  // namespace idim::generator
