#include "graph/expression_graph.hpp"

#include <cln/dfloat.h>
#include <cln/float.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "graph/evaluate.hpp"
#include "graph/operation_count.hpp"

namespace idim::generator {

namespace {

rational fraction(long numerator, long denominator) {
    return rational(numerator) / rational(denominator);
}

class ExpressionGraph : public testing::Test {
  protected:
    signed_node leaf(const std::string& name, symbol_role role = symbol_role::position) {
        return graph.symbol({name, role, 0});
    }
    signed_node number(long value) { return graph.constant(rational(value)); }
    rational value_of(signed_node n) const { return n.negative ? -graph[n].value : graph[n].value; }

    expression_graph graph;
    signed_node a = leaf("a"), b = leaf("b"), c = leaf("c");
};

TEST_F(ExpressionGraph, FindsSumsAndProductsWhateverTheOrderOfOperands) {
    EXPECT_EQ(graph.add(a, b), graph.add(b, a));
    EXPECT_EQ(graph.multiply(a, b), graph.multiply(b, a));
    EXPECT_FALSE(graph.divide(a, b) == graph.divide(b, a));
}

TEST_F(ExpressionGraph, FindsThemWhateverTheirSigns) {
    EXPECT_EQ(graph.subtract(a, b), -graph.subtract(b, a));
    EXPECT_EQ(graph.add(-a, -b), -graph.add(a, b));
    EXPECT_EQ(graph.multiply(-a, b), -graph.multiply(a, b));
    EXPECT_EQ(graph.multiply(-a, -b), graph.multiply(a, b));
    EXPECT_EQ(graph.divide(-a, b), graph.divide(a, -b));
    EXPECT_FALSE(graph.add(a, b) == graph.subtract(a, b));
    EXPECT_NE(graph.add(a, b).id, graph.subtract(a, b).id);
}

TEST_F(ExpressionGraph, FoldsConstantsExactly) {
    EXPECT_EQ(value_of(graph.add(graph.constant(fraction(1, 3)), graph.constant(fraction(1, 6)))), fraction(1, 2));
    EXPECT_EQ(value_of(graph.add(graph.constant(fraction(1, 10)), graph.constant(fraction(2, 10)))), fraction(3, 10));
    EXPECT_EQ(value_of(graph.multiply(graph.constant(fraction(-2, 3)), graph.constant(fraction(3, 4)))),
              fraction(-1, 2));
    EXPECT_EQ(value_of(graph.divide(number(1), number(-3))), fraction(-1, 3));
    EXPECT_EQ(value_of(graph.power(graph.constant(fraction(2, 3)), -2)), fraction(9, 4));
    // 2^-60 is lost beside 1 in double precision.
    const signed_node tiny = graph.power(graph.constant(fraction(1, 2)), 60);
    EXPECT_EQ(graph.subtract(graph.add(number(1), tiny), number(1)), tiny);
}

TEST_F(ExpressionGraph, RemovesZerosAndOnes) {
    EXPECT_EQ(graph.add(a, number(0)), a);
    EXPECT_EQ(graph.multiply(a, number(1)), a);
    EXPECT_EQ(graph.multiply(number(-1), a), -a);
    EXPECT_TRUE(graph.is_zero(graph.multiply(a, number(0))));
    EXPECT_TRUE(graph.is_zero(graph.divide(number(0), a)));
    EXPECT_EQ(graph.divide(a, number(1)), a);
    EXPECT_EQ(graph.power(a, 0), number(1));
    EXPECT_EQ(graph.power(a, 1), a);
}

TEST_F(ExpressionGraph, CancelsWhatIsEqual) {
    EXPECT_TRUE(graph.is_zero(graph.subtract(a, a)));
    EXPECT_EQ(graph.divide(a, a), number(1));
    EXPECT_EQ(graph.divide(-a, a), -number(1));
    EXPECT_EQ(graph.add(a, a), graph.multiply(number(2), a));
    EXPECT_TRUE(graph.is_zero(graph.subtract(graph.multiply(a, b), graph.multiply(b, a))));
}

TEST_F(ExpressionGraph, GathersConstantFactors) {
    const signed_node product = graph.multiply(graph.constant(fraction(1, 2)), graph.multiply(number(-6), a));
    EXPECT_EQ(product, graph.multiply(number(-3), a));
    EXPECT_EQ(graph.multiply(graph.constant(fraction(1, 3)), graph.multiply(number(3), a)), a);
}

TEST_F(ExpressionGraph, KnowsTheParityOfFunctions) {
    using enum function_kind;
    for (const function_kind odd : {function_kind::sin, tan, function_kind::sign, function_kind::tanh, atan}) {
        EXPECT_EQ(graph.function(odd, -a), -graph.function(odd, a)) << to_string(odd);
        EXPECT_TRUE(graph.is_zero(graph.function(odd, number(0)))) << to_string(odd);
    }
    for (const function_kind even : {function_kind::cos, function_kind::abs}) {
        EXPECT_EQ(graph.function(even, -a), graph.function(even, a)) << to_string(even);
    }
    EXPECT_EQ(graph.function(cos, number(0)), number(1));
    EXPECT_EQ(graph.function(exp, number(0)), number(1));
    EXPECT_FALSE(graph.function(exp, -a) == graph.function(exp, a));
    EXPECT_FALSE(graph.function(exp, -a) == -graph.function(exp, a));
}

TEST_F(ExpressionGraph, SignForgetsAConstantFactorButNotItsSign) {
    const signed_node plain = graph.function(function_kind::sign, a);
    EXPECT_EQ(graph.function(function_kind::sign, graph.multiply(number(3), a)), plain);
    EXPECT_EQ(graph.function(function_kind::sign, graph.multiply(number(-3), a)), -plain);
    EXPECT_FALSE(graph.function(function_kind::abs, graph.multiply(number(3), a)) ==
                 graph.function(function_kind::abs, a));
}

TEST_F(ExpressionGraph, DivisionByZeroIsALogicError) {
    EXPECT_THROW(graph.divide(a, number(0)), std::logic_error);
    EXPECT_THROW(graph.power(number(0), -1), std::logic_error);
}

TEST_F(ExpressionGraph, SameNameAndRoleIsTheSameLeaf) {
    EXPECT_EQ(leaf("a"), a);
    EXPECT_NE(leaf("a", symbol_role::velocity).id, a.id);
    EXPECT_EQ(graph.symbols().size(), 4u);
}

TEST_F(ExpressionGraph, CountsOnlyWhatAnOutputNeeds) {
    const signed_node kept = graph.multiply(graph.add(a, b), c);
    graph.divide(graph.multiply(a, c), b);  // dead
    graph.output("y", 0, kept);
    const operation_count count = count_operations(graph);
    EXPECT_EQ(count.mul, 1);
    EXPECT_EQ(count.add, 1);
    EXPECT_EQ(count.div, 0);
    const std::vector<bool> live = graph.live();
    EXPECT_EQ(std::count(live.begin(), live.end(), true), 5);  // a b c, sum, product
}

TEST_F(ExpressionGraph, CountsASquareOnceAnEighthPowerThreeTimesAndSignsNever) {
    graph.output("y", 0, -graph.multiply(a, a));
    EXPECT_EQ(count_operations(graph).mul, 1);
    graph.output("y", 1, graph.power(a, 8));
    EXPECT_EQ(count_operations(graph).mul, 3);
    EXPECT_EQ(count_operations(graph).add, 0);
}

TEST_F(ExpressionGraph, DoesNotCountWhatParametersAloneDecide) {
    const signed_node p = leaf("p", symbol_role::parameter);
    const signed_node r = leaf("r", symbol_role::parameter);
    graph.output("y", 0, graph.multiply(graph.divide(p, graph.add(p, r)), a));
    const operation_count count = count_operations(graph);
    EXPECT_EQ(count.mul, 1);
    EXPECT_EQ(count.add, 0);
    EXPECT_EQ(count.div, 0);
}

TEST_F(ExpressionGraph, CountsFunctionsApart) {
    graph.output("y", 0, graph.multiply(graph.function(function_kind::sin, a), graph.function(function_kind::cos, a)));
    graph.output("y", 1, graph.function(function_kind::sin, -a));
    EXPECT_EQ(count_operations(graph).functions, 2);
    EXPECT_EQ(count_operations(graph).mul, 1);
}

TEST_F(ExpressionGraph, AFirstNameStays) {
    const signed_node sum = graph.add(a, b);
    graph.name(sum, "first");
    graph.name(sum, "second");
    EXPECT_EQ(graph[sum].name, "first");
}

TEST(RandomExpressionGraph, KeepsItsInvariantsAndTheValueOfWhatWasBuilt) {
    std::mt19937_64 random(3);
    const auto choose = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
    for (int trial = 0; trial < 20; ++trial) {
        expression_graph graph;
        std::vector<double> leaves;
        std::vector<std::pair<signed_node, double>> built;
        for (int i = 0; i < 6; ++i) {
            leaves.push_back(std::uniform_real_distribution<double>(0.5, 1.5)(random));
            built.emplace_back(graph.symbol({"x" + std::to_string(i), symbol_role::position, i}), leaves.back());
        }
        built.emplace_back(graph.constant(fraction(3, 4)), 0.75);
        for (int i = 0; i < 300; ++i) {
            const auto [x, x_value] = built[choose(built.size())];
            const auto [y, y_value] = built[choose(built.size())];
            switch (choose(6)) {
                case 0:
                    built.emplace_back(graph.add(x, y), x_value + y_value);
                    break;
                case 1:
                    built.emplace_back(graph.subtract(x, y), x_value - y_value);
                    break;
                case 2:
                    built.emplace_back(graph.multiply(x, y), x_value * y_value);
                    break;
                case 3:
                    if (!graph.is_zero(y) && std::abs(y_value) > 1e-3) {
                        built.emplace_back(graph.divide(x, y), x_value / y_value);
                    }
                    break;
                case 4:
                    built.emplace_back(graph.function(function_kind::sin, x), std::sin(x_value));
                    break;
                default:
                    built.emplace_back(-x, -x_value);
            }
            if (std::abs(built.back().second) > 1e3) {
                built.pop_back();
            }
        }
        for (std::size_t i = 0; i < built.size(); ++i) {
            graph.output("y", static_cast<int>(i), built[i].first);
        }
        EXPECT_NO_THROW(graph.assert_invariants());
        double_arithmetic arithmetic;
        const std::vector<double> values = evaluate(graph, leaves, arithmetic);
        for (std::size_t i = 0; i < built.size(); ++i) {
            // Values to 1e3 and divisors down to 1e-3 amplify rounding along the chain.
            EXPECT_NEAR(values[i], built[i].second, 1e-7 * std::max(1.0, std::abs(built[i].second)));
        }
    }
}

TEST(Rational, DecimalTextReadsBackAsTheNearestDouble) {
    for (const double value : {0.1, 1e-5, 123.456, 1.0 / 3.0, 6.02e23}) {
        EXPECT_EQ(std::stod(to_decimal(cln::rational(cln::cl_DF(value)))), value);
    }
    EXPECT_EQ(to_decimal(fraction(1, 4)), "0.25");
    EXPECT_EQ(to_fraction(fraction(-42, 200)), "-21/100");
    EXPECT_EQ(to_double(fraction(1, 3)), 1.0 / 3.0);
}

}  // namespace

}  // namespace idim::generator
