#include "backend/cpp_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace idim::generator {

namespace {

class CppBody : public testing::Test {
  protected:
    signed_node leaf(const std::string& name, int index) { return graph.symbol({name, symbol_role::position, index}); }

    /// The statements without what declares nothing but names, one text.
    std::string printed(const std::set<std::string>& reserved = {"q", "Scalar"}) const {
        std::string text;
        for (const std::string& line : print_cpp(graph, reserved)) {
            text += line + "\n";
        }
        return text;
    }

    expression_graph graph;
    signed_node a = leaf("q1", 0), b = leaf("q2", 1), c = leaf("q3", 2);
};

}  // namespace

TEST_F(CppBody, ParenthesesKeepTheOrderOfOperations) {
    graph.output("y", 0, graph.multiply(graph.add(a, b), c));
    graph.output("y", 1, graph.divide(a, graph.multiply(b, c)));
    graph.output("y", 2, graph.divide(c, graph.divide(a, b)));
    const std::string text = printed();
    EXPECT_NE(text.find("(q[0] + q[1])"), std::string::npos) << text;
    EXPECT_NE(text.find("q[0] / (q[1] * q[2])"), std::string::npos) << text;
    EXPECT_NE(text.find("q[2] / (q[0] / q[1])"), std::string::npos) << text;
}

TEST_F(CppBody, WhatIsUsedTwiceIsComputedOnce) {
    const signed_node sum = graph.add(a, b);
    graph.output("y", 0, graph.multiply(sum, c));
    graph.output("y", 1, graph.divide(c, sum));
    const std::string text = printed();
    EXPECT_EQ(text.find("q[0] + q[1]"), text.rfind("q[0] + q[1]")) << text;
}

TEST_F(CppBody, DeadNodesAreNotPrinted) {
    const signed_node dead = graph.divide(a, c);
    graph.name(dead, "unused");
    graph.output("y", 0, graph.add(a, b));
    EXPECT_EQ(printed().find("unused"), std::string::npos);
    EXPECT_EQ(printed().find('/'), std::string::npos);
}

TEST_F(CppBody, ReservedNamesAreAvoided) {
    const signed_node sum = graph.add(a, b);
    graph.name(sum, "sin");
    graph.output("y", 0, graph.multiply(sum, sum));
    const std::string text = printed({"q", "sin", "Scalar"});
    EXPECT_EQ(text.find(" sin ="), std::string::npos) << text;
    EXPECT_NE(text.find("const Scalar sin_"), std::string::npos) << text;
}

TEST_F(CppBody, ConstantsReadBackExactly) {
    graph.output("y", 0, graph.multiply(graph.constant(rational(1) / rational(3)), a));
    EXPECT_NE(printed().find("Scalar(0.3333333333333333)"), std::string::npos) << printed();
}

TEST_F(CppBody, TheSameGraphPrintsTheSameText) {
    graph.output("y", 0, graph.multiply(graph.add(a, b), graph.function(function_kind::sin, c)));
    EXPECT_EQ(printed(), printed());
}

}  // namespace idim::generator
