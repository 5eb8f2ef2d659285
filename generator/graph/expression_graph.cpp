#include "graph/expression_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace idim::generator {

const char* to_string(function_kind kind) {
    switch (kind) {
        case function_kind::none:
            return "none";
        case function_kind::sin:
            return "sin";
        case function_kind::cos:
            return "cos";
        case function_kind::tan:
            return "tan";
        case function_kind::exp:
            return "exp";
        case function_kind::log:
            return "log";
        case function_kind::sqrt:
            return "sqrt";
        case function_kind::abs:
            return "abs";
        case function_kind::sign:
            return "sign";
        case function_kind::tanh:
            return "tanh";
        case function_kind::atan:
            return "atan";
        case function_kind::pow:
            return "pow";
    }
    return "?";
}

std::size_t expression_graph::key_hash::operator()(const key& k) const {
    const auto& [kind, function, a, a_negative, b, b_negative] = k;
    std::size_t hash = static_cast<std::size_t>(kind) * 16 + static_cast<std::size_t>(function);
    hash = hash * 1000003u + static_cast<std::size_t>(a) * 2 + (a_negative ? 1 : 0);
    return hash * 1000003u + static_cast<std::size_t>(b) * 2 + (b_negative ? 1 : 0);
}

expression_graph::expression_graph() {
    zero_ = constant(0).id;
    one_ = constant(1).id;
}

void expression_graph::reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    known_.reserve(nodes);
}

signed_node expression_graph::constant(const rational& value) {
    const bool negative = cln::minusp(value);
    const rational magnitude = cln::abs(value);
    const auto [at, fresh] = constants_.try_emplace(magnitude, static_cast<int>(nodes_.size()));
    if (fresh) {
        graph_node node;
        node.kind = operation::constant;
        node.value = magnitude;
        nodes_.push_back(std::move(node));
    }
    return {at->second, negative};
}

signed_node expression_graph::symbol(const graph_symbol& leaf) {
    const auto [at, fresh] = leaves_.try_emplace({leaf.role, leaf.name}, static_cast<int>(nodes_.size()));
    if (fresh) {
        graph_node node;
        node.kind = operation::symbol;
        node.symbol = static_cast<int>(symbols_.size());
        node.role = leaf.role;
        node.name = leaf.name;
        symbols_.push_back(leaf);
        nodes_.push_back(std::move(node));
    }
    return {at->second, false};
}

rational expression_graph::signed_value(signed_node value) const {
    const rational& magnitude = (*this)[value].value;
    return value.negative ? -magnitude : magnitude;
}

signed_node expression_graph::intern(operation kind, function_kind function, signed_node a, signed_node b) {
    const auto [at, fresh] =
        known_.try_emplace(key{kind, function, a.id, a.negative, b.id, b.negative}, static_cast<int>(nodes_.size()));
    if (fresh) {
        graph_node node;
        node.kind = kind;
        node.function = function;
        node.a = a;
        node.b = b;
        node.role = std::max((*this)[a].role, (*this)[b].role);
        nodes_.push_back(std::move(node));
    }
    return {at->second, false};
}

signed_node expression_graph::add(signed_node a, signed_node b) {
    if (is_zero(a)) {
        return b;
    }
    if (is_zero(b)) {
        return a;
    }
    if (is_constant(a) && is_constant(b)) {
        return constant(signed_value(a) + signed_value(b));
    }
    if (a.id == b.id) {
        return a.negative == b.negative ? multiply(constant(2), a) : constant(0);
    }
    if (a.id > b.id) {
        std::swap(a, b);
    }
    const bool negative = a.negative;
    const signed_node sum =
        intern(operation::add, function_kind::none, {a.id, false}, {b.id, a.negative != b.negative});
    return {sum.id, negative};
}

signed_node expression_graph::multiply(signed_node a, signed_node b) {
    const bool negative = a.negative != b.negative;
    if (is_zero(a) || is_zero(b)) {
        return constant(0);
    }
    if (is_constant(a) && is_constant(b)) {
        return constant(signed_value(a) * signed_value(b));
    }
    a.negative = b.negative = false;
    if (a.id == one_) {
        return {b.id, negative};
    }
    if (b.id == one_) {
        return {a.id, negative};
    }
    if (is_constant(b)) {
        std::swap(a, b);
    }
    // c1 * (c2 * x) = (c1 c2) * x
    if (is_constant(a) && (*this)[b].kind == operation::multiply && is_constant((*this)[b].a)) {
        const signed_node inner = (*this)[b].b;
        const signed_node product = multiply(constant((*this)[a].value * (*this)[(*this)[b].a].value), inner);
        return {product.id, product.negative != negative};
    }
    if (!is_constant(a) && a.id > b.id) {
        std::swap(a, b);
    }
    return {intern(operation::multiply, function_kind::none, a, b).id, negative};
}

signed_node expression_graph::divide(signed_node a, signed_node b) {
    if (is_zero(b)) {
        throw std::logic_error("division by zero in an expression graph");
    }
    if (is_constant(b)) {
        return multiply(a, constant(1 / signed_value(b)));
    }
    const bool negative = a.negative != b.negative;
    if (is_zero(a)) {
        return a;
    }
    if (a.id == b.id) {
        return {one_, negative};
    }
    return {intern(operation::divide, function_kind::none, {a.id, false}, {b.id, false}).id, negative};
}

signed_node expression_graph::power(signed_node base, int exponent) {
    if (exponent < 0) {
        return divide({one_, false}, power(base, -exponent));
    }
    if (exponent == 0) {
        return {one_, false};
    }
    if (exponent == 1) {
        return base;
    }
    const signed_node half = power(base, exponent / 2);
    const signed_node square = multiply(half, half);
    return exponent % 2 == 0 ? square : multiply(square, base);
}

/// sign(c x) = sign(x) for a positive constant c.
signed_node expression_graph::without_scale(signed_node value) const {
    const graph_node& node = (*this)[value];
    const bool scaled = node.kind == operation::multiply && is_constant(node.a);
    return scaled ? signed_node{node.b.id, value.negative != node.b.negative} : value;
}

signed_node expression_graph::function(function_kind kind, signed_node argument) {
    const bool is_odd = kind == function_kind::sin || kind == function_kind::tan || kind == function_kind::sign ||
                        kind == function_kind::tanh || kind == function_kind::atan;
    const bool is_even = kind == function_kind::cos || kind == function_kind::abs;
    if (is_zero(argument)) {
        if (is_odd || kind == function_kind::abs || kind == function_kind::sqrt) {
            return argument;
        }
        if (kind == function_kind::cos || kind == function_kind::exp) {
            return {one_, false};
        }
    }
    if (kind == function_kind::sign) {
        argument = without_scale(argument);
    }
    if (!is_odd && !is_even) {
        return intern(operation::function, kind, argument, {zero_, false});
    }
    const signed_node value = intern(operation::function, kind, {argument.id, false}, {zero_, false});
    return {value.id, is_odd && argument.negative};
}

signed_node expression_graph::function_pow(signed_node base, signed_node exponent) {
    return intern(operation::function, function_kind::pow, base, exponent);
}

void expression_graph::name(signed_node value, const std::string& name) {
    graph_node& node = nodes_[static_cast<std::size_t>(value.id)];
    if (node.name.empty() && node.kind != operation::constant) {
        node.name = name;
    }
}

std::vector<bool> expression_graph::live() const {
    std::vector<bool> needed(nodes_.size(), false);
    for (const graph_output& out : outputs_) {
        needed[static_cast<std::size_t>(out.value.id)] = true;
    }
    for (std::size_t id = nodes_.size(); id-- > 0;) {
        const graph_node& node = nodes_[id];
        if (!needed[id] || node.kind == operation::constant || node.kind == operation::symbol) {
            continue;
        }
        needed[static_cast<std::size_t>(node.a.id)] = true;
        if (node.kind != operation::function || node.function == function_kind::pow) {
            needed[static_cast<std::size_t>(node.b.id)] = true;
        }
    }
    return needed;
}

void expression_graph::assert_invariants() const {
    std::vector<key> keys;
    keys.reserve(nodes_.size());
    for (std::size_t id = 0; id < nodes_.size(); ++id) {
        const graph_node& node = nodes_[id];
        if (node.kind == operation::constant || node.kind == operation::symbol) {
            continue;
        }
        const auto here = static_cast<int>(id);
        if (node.a.id >= here || node.b.id >= here) {
            throw std::logic_error(fmt::format("node {} refers forward to {} or {}", here, node.a.id, node.b.id));
        }
        if (node.kind == operation::add && (node.a.negative || node.a.id >= node.b.id)) {
            throw std::logic_error(fmt::format("sum {} not in normal form: {} {}", here, node.a.id, node.b.id));
        }
        if (node.kind == operation::multiply &&
            (node.a.negative || node.b.negative || (!is_constant(node.a) && node.a.id > node.b.id))) {
            throw std::logic_error(fmt::format("product {} not in normal form: {} {}", here, node.a.id, node.b.id));
        }
        keys.push_back({node.kind, node.function, node.a.id, node.a.negative, node.b.id, node.b.negative});
    }
    std::sort(keys.begin(), keys.end());
    const auto twice = std::adjacent_find(keys.begin(), keys.end());
    if (twice != keys.end()) {
        throw std::logic_error(
            fmt::format("a node of {} and {} stands twice", std::get<2>(*twice), std::get<4>(*twice)));
    }
}

namespace {

std::string operand(const expression_graph& graph, signed_node value) {
    const graph_node& node = graph[value];
    const std::string text = node.kind == operation::constant ? to_fraction(node.value)
                             : node.name.empty()              ? fmt::format("#{}", value.id)
                                                              : node.name;
    return (value.negative ? "-" : "") + text;
}

}  // namespace

std::string to_string(const expression_graph& graph) {
    std::string text;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < graph.nodes().size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (!live[id] || node.kind == operation::constant || node.kind == operation::symbol) {
            continue;
        }
        const std::string left = operand(graph, {static_cast<int>(id), false});
        const std::string a = operand(graph, node.a);
        const std::string b = operand(graph, node.b);
        if (node.kind == operation::function) {
            text += fmt::format("{} = {}({})\n", left, to_string(node.function), a);
        } else {
            const char* sign = node.kind == operation::add ? " + " : node.kind == operation::multiply ? " * " : " / ";
            text += fmt::format("{} = {}{}{}\n", left, a, sign, b);
        }
    }
    for (const graph_output& out : graph.outputs()) {
        text += fmt::format("{}[{}] = {}\n", out.array, out.index, operand(graph, out.value));
    }
    return text;
}

}  // namespace idim::generator
