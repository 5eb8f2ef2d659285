// Sums rewritten on the graph: fewer operations, the same values.
#include <gtest/gtest.h>

#include "graph/cost_model.hpp"
#include "graph/evaluate.hpp"
#include "graph/operation_count.hpp"
#include "graph/sum_rewriting.hpp"

namespace idim::generator {

namespace {

/// Leaves p, q (parameters) and x, y, z (velocities).
struct leaves {
    expression_graph graph;
    signed_node p = graph.symbol({"p", symbol_role::parameter, 0});
    signed_node q = graph.symbol({"q", symbol_role::parameter, 1});
    signed_node x = graph.symbol({"x", symbol_role::velocity, 0});
    signed_node y = graph.symbol({"y", symbol_role::velocity, 1});
    signed_node z = graph.symbol({"z", symbol_role::velocity, 2});

    signed_node sum(signed_node a, signed_node b) { return graph.add(a, b); }
    signed_node product(signed_node a, signed_node b) { return graph.multiply(a, b); }
};

double value_of(const expression_graph& graph) {
    const std::map<std::string, double> of = {{"p", 3.0}, {"q", -1.5}, {"x", 0.25}, {"y", 7.0}, {"z", -2.0}};
    std::vector<double> given;
    for (const graph_symbol& symbol : graph.symbols()) {
        given.push_back(of.at(symbol.name));
    }
    double_arithmetic arithmetic;
    return evaluate(graph, given, arithmetic).front();
}

/// Multiplications and additions after rewriting; the value, exact in these numbers, must stay.
std::pair<int, int> rewritten(leaves& of, signed_node result) {
    of.graph.output("out", 0, result);
    const expression_graph after = with_rewritten_sums(of.graph);
    after.assert_invariants();
    EXPECT_EQ(value_of(after), value_of(of.graph));
    const operation_count count = count_operations(after);
    return {count.mul, count.add};
}

}  // namespace

TEST(SumRewriting, AddsParametersFirst) {
    leaves of;
    EXPECT_EQ(rewritten(of, of.sum(of.p, -of.sum(of.q, -of.product(of.x, of.y)))), std::pair(1, 1));
}

TEST(SumRewriting, TakesACommonFactorOut) {
    leaves of;
    const signed_node sum = of.sum(of.sum(of.product(of.p, of.x), of.z), -of.product(of.p, of.y));
    EXPECT_EQ(rewritten(of, sum), std::pair(1, 2));
}

TEST(SumRewriting, LeavesWhatIsNeededElsewhere) {
    leaves of;
    const signed_node shared = of.product(of.p, of.x);
    const signed_node sum = of.sum(of.sum(shared, of.product(of.p, of.y)), of.z);
    EXPECT_EQ(rewritten(of, of.product(sum, shared)), std::pair(3, 2));
}

TEST(CostModel, X86TakesAProductThatNothingElseNeedsIntoASum) {
    leaves fused;
    fused.graph.output("out", 0, fused.sum(fused.product(fused.x, fused.y), fused.z));
    EXPECT_EQ(cost(fused.graph, cost_target::x86), 1 + 2 * 4);
    leaves apart;
    const signed_node product = apart.product(apart.x, apart.y);
    apart.graph.output("out", 0, apart.sum(product, apart.z));
    apart.graph.output("out", 1, product);
    EXPECT_EQ(cost(apart.graph, cost_target::x86), 2 + 2 * 8);
}

TEST(CostModel, McuCountsLoadsAndOperationsAndOpsOnlyTheseBeyondParameters) {
    leaves of;
    of.graph.output("out", 0, of.product(of.x, of.sum(of.p, of.q)));
    EXPECT_EQ(cost(of.graph, cost_target::mcu), 3 * 4 + 2 * 2);  // half cycles: x, p and q loaded, two operations
    EXPECT_EQ(cost(of.graph, cost_target::operations), 1);
}

}  // namespace idim::generator
