#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "graph/rational.hpp"

namespace idim::generator {

/// What a leaf stands for; also the order in which operands of a sum or product are sorted, so that what depends on
/// constants alone, then on parameters alone, gathers at the left and is computed once.
enum class symbol_role {
    constant,
    parameter,
    standard,
    time,
    temperature,
    position,
    velocity,
    acceleration,
    torque,
    rigid_torque,
    motor,
    state,
    step,
    sine,
    intermediate,
};

/// A leaf: `name` for printing, `index` its place in the argument array of its role.
struct graph_symbol {
    std::string name;
    symbol_role role = symbol_role::constant;
    int index = 0;
};

enum class operation : std::uint8_t { constant, symbol, add, multiply, divide, function };

enum class function_kind : std::uint8_t { none, sin, cos, tan, exp, log, sqrt, abs, sign, tanh, atan, pow };

const char* to_string(function_kind kind);

/// A value of the graph with its sign. Signs live on the edges, never in nodes of their own: -(a*b), a*(-b) and (-a)*b
/// are one node, and a sign costs no operation (as in the operation counts of the literature).
struct signed_node {
    int id = 0;
    bool negative = false;

    signed_node operator-() const { return {id, !negative}; }
    bool operator==(const signed_node& other) const { return id == other.id && negative == other.negative; }
};

/// One operation. Operands of sums and products are ordered by id; the first operand of a sum is positive, operands of
/// a product and of a quotient are positive.
struct graph_node {
    operation kind = operation::constant;
    function_kind function = function_kind::none;
    signed_node a, b;  ///< operands; b unused by functions of one argument
    int symbol = -1;   ///< into symbols(), for operation::symbol
    rational value;    ///< for operation::constant, never negative
    std::string name;  ///< the intermediate this node was assigned to, empty if it only occurs inside expressions
    symbol_role role = symbol_role::constant;  ///< the latest role among the leaves below
};

/// Named result of a graph: one element of an output array.
struct graph_output {
    std::string array;
    int index = 0;  ///< position in the array
    signed_node value;
};

/// Hash-consed directed acyclic graph of scalar operations. A node is created once, after its operands, and its id is
/// its place in the order of creation; since the callers create nodes in an order that depends on declared symbol
/// indices alone, the ids do too, and what is emitted is the same on every run and machine.
///
/// Simplifies as it builds: constants folded exactly, 0 and 1 removed, a-a and a/a, common operands found whatever
/// their order or sign.
class expression_graph {
  public:
    expression_graph();

    /// Makes room for so many nodes.
    void reserve(std::size_t nodes);

    signed_node constant(const rational& value);
    signed_node zero() const { return {zero_, false}; }
    signed_node one() const { return {one_, false}; }
    /// Declares a leaf; the same name and role always give the same leaf.
    signed_node symbol(const graph_symbol& leaf);

    signed_node add(signed_node a, signed_node b);
    signed_node subtract(signed_node a, signed_node b) { return add(a, -b); }
    signed_node multiply(signed_node a, signed_node b);
    signed_node divide(signed_node a, signed_node b);
    signed_node power(signed_node base, int exponent);
    signed_node function(function_kind kind, signed_node argument);
    /// base^exponent with an exponent that is no integer.
    signed_node function_pow(signed_node base, signed_node exponent);

    /// Gives a node the name of the intermediate it holds; the first name stays.
    void name(signed_node value, const std::string& name);
    void output(const std::string& array, int index, signed_node value) { outputs_.push_back({array, index, value}); }

    const std::vector<graph_node>& nodes() const { return nodes_; }
    const graph_node& operator[](signed_node value) const { return nodes_[static_cast<std::size_t>(value.id)]; }
    const std::vector<graph_symbol>& symbols() const { return symbols_; }
    const std::vector<graph_output>& outputs() const { return outputs_; }

    bool is_constant(signed_node value) const { return (*this)[value].kind == operation::constant; }
    bool is_zero(signed_node value) const { return value.id == zero_; }

    /// Marks the nodes that some output needs.
    std::vector<bool> live() const;

    /// Throws std::logic_error when a node refers forward, an operand order or sign rule is broken, or a node stands
    /// twice.
    void assert_invariants() const;

  private:
    using key = std::tuple<operation, function_kind, int, bool, int, bool>;
    struct key_hash {
        std::size_t operator()(const key& k) const;
    };

    signed_node intern(operation kind, function_kind function, signed_node a, signed_node b);
    rational signed_value(signed_node value) const;
    signed_node without_scale(signed_node value) const;

    std::vector<graph_node> nodes_;
    std::vector<graph_symbol> symbols_;
    std::vector<graph_output> outputs_;
    std::unordered_map<key, int, key_hash> known_;
    struct smaller {
        bool operator()(const rational& a, const rational& b) const { return cln::compare(a, b) < 0; }
    };
    std::map<rational, int, smaller> constants_;
    std::map<std::pair<symbol_role, std::string>, int> leaves_;
    int zero_ = 0;
    int one_ = 0;
};

/// One line per live node: "W2_3 = W1_3 + qd2".
std::string to_string(const expression_graph& graph);

}  // namespace idim::generator
