#include "backend/body_printer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace idim::generator {

namespace {

class BodyPrinter : public testing::Test {
  protected:
    signed_node leaf(const std::string& name, int index) { return graph.symbol({name, symbol_role::position, index}); }

    /// The statements as one text.
    std::string printed(const language& spelling, const std::set<std::string>& reserved = {"q"}) const {
        std::string text;
        for (const std::string& line : print_body(graph, spelling, reserved)) {
            text += line + "\n";
        }
        return text;
    }
    std::string printed(const std::set<std::string>& reserved = {"q"}) const {
        return printed(*cpp_languages().front(), reserved);
    }

    expression_graph graph;
    signed_node a = leaf("q1", 0), b = leaf("q2", 1), c = leaf("q3", 2);
};

TEST_F(BodyPrinter, ParenthesesKeepTheOrderOfOperations) {
    graph.output("y", 0, graph.multiply(graph.add(a, b), c));
    graph.output("y", 1, graph.divide(a, graph.multiply(b, c)));
    graph.output("y", 2, graph.divide(c, graph.divide(a, b)));
    const std::string text = printed();
    EXPECT_NE(text.find("(q[0] + q[1])"), std::string::npos) << text;
    EXPECT_NE(text.find("q[0] / (q[1] * q[2])"), std::string::npos) << text;
    EXPECT_NE(text.find("q[2] / (q[0] / q[1])"), std::string::npos) << text;
}

TEST_F(BodyPrinter, WhatIsUsedTwiceIsComputedOnce) {
    const signed_node sum = graph.add(a, b);
    graph.output("y", 0, graph.multiply(sum, c));
    graph.output("y", 1, graph.divide(c, sum));
    const std::string text = printed();
    EXPECT_EQ(text.find("q[0] + q[1]"), text.rfind("q[0] + q[1]")) << text;
}

TEST_F(BodyPrinter, DeadNodesAreNotPrinted) {
    const signed_node dead = graph.divide(a, c);
    graph.name(dead, "unused");
    graph.output("y", 0, graph.add(a, b));
    EXPECT_EQ(printed().find("unused"), std::string::npos);
    EXPECT_EQ(printed().find('/'), std::string::npos);
}

TEST_F(BodyPrinter, ReservedNamesAreAvoided) {
    const signed_node sum = graph.add(a, b);
    graph.name(sum, "sin");
    graph.output("y", 0, graph.multiply(sum, sum));
    const std::string text = printed({"q", "sin"});
    EXPECT_EQ(text.find(" sin ="), std::string::npos) << text;
    EXPECT_NE(text.find("const Scalar sin_"), std::string::npos) << text;
}

TEST_F(BodyPrinter, ConstantsReadBackExactly) {
    graph.output("y", 0, graph.multiply(graph.constant(rational(1) / rational(3)), a));
    EXPECT_NE(printed().find("Scalar(0.3333333333333333)"), std::string::npos) << printed();
}

TEST_F(BodyPrinter, NumbersOfCAreNeverIntegersAndOneOfFloatEndsInF) {
    const languages scalars = c_languages();
    EXPECT_EQ(scalars[0]->number(2), "2.0");
    EXPECT_EQ(scalars[1]->number(2), "2.0f");
    EXPECT_EQ(scalars[0]->number(rational(1) / rational(3)), "0.3333333333333333");
    EXPECT_EQ(scalars[1]->number(rational(1) / rational(3)), "0.33333334f");
    EXPECT_EQ(scalars[0]->number(rational(1) / rational(100000)), "1e-05");
    EXPECT_EQ(scalars[1]->number(cln::expt(rational(10), 40)), "INFINITY");  // what a conversion from double gives
}

TEST_F(BodyPrinter, FunctionsOfCHaveTheNamesOfTheirScalar) {
    const signed_node size = graph.function(function_kind::abs, a);
    graph.output("y", 0, graph.add(size, graph.function(function_kind::tanh, b)));
    graph.output("y", 1, graph.function_pow(a, graph.constant(rational(3) / rational(2))));
    graph.output("y", 2, graph.function(function_kind::sign, c));
    EXPECT_EQ(printed(*c_languages()[0]),
              "y[0] = fabs(q[0]) + tanh(q[1]);\ny[1] = pow(q[0], 1.5);\ny[2] = sign(q[2]);\n");
    EXPECT_EQ(printed(*c_languages()[1]),
              "y[0] = fabsf(q[0]) + tanhf(q[1]);\ny[1] = powf(q[0], 1.5f);\ny[2] = sign(q[2]);\n");
}

TEST_F(BodyPrinter, TheSameGraphPrintsTheSameText) {
    graph.output("y", 0, graph.multiply(graph.add(a, b), graph.function(function_kind::sin, c)));
    EXPECT_EQ(printed(), printed());
}

}  // namespace

}  // namespace idim::generator
