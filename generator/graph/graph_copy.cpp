#include "graph/graph_copy.hpp"

namespace idim::generator {

signed_node graph_copy::of(signed_node value) {
    std::optional<signed_node>& known = known_[static_cast<std::size_t>(value.id)];
    if (!known) {
        const graph_node& node = from_[value];
        known = build(node);
        if (!node.name.empty() && !known->negative) {
            to_.name(*known, node.name);
        }
    }
    return value.negative ? -*known : *known;
}

signed_node graph_copy::build(const graph_node& node) {
    switch (node.kind) {
        case operation::constant:
            return to_.constant(node.value);
        case operation::symbol:
            return to_.symbol(from_.symbols()[static_cast<std::size_t>(node.symbol)]);
        default:
            break;
    }
    const signed_node a = of(node.a);
    const signed_node b = of(node.b);
    switch (node.kind) {
        case operation::add:
            return to_.add(a, b);
        case operation::multiply:
            return to_.multiply(a, b);
        case operation::divide:
            return to_.divide(a, b);
        default:
            return node.function == function_kind::pow ? to_.function_pow(a, b) : to_.function(node.function, a);
    }
}

}  // namespace idim::generator
