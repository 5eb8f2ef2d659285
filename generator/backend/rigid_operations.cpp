#include "backend/rigid_operations.hpp"

#include "graph/graph_copy.hpp"
#include "graph/sum_rewriting.hpp"

namespace idim::generator {

operation_count rigid_operations(const expression_graph& model, const std::vector<bool>& is_of_link) {
    const auto is_of_effect = [&](const graph_node& node) {
        return node.kind == operation::symbol && node.role == symbol_role::parameter &&
               !is_of_link[static_cast<std::size_t>(model.symbols()[static_cast<std::size_t>(node.symbol)].index)];
    };
    expression_graph links;
    links.reserve(model.nodes().size());
    graph_copy copy(model, links);
    const std::vector<bool> live = model.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = model.nodes()[id];
        if (!live[id]) {
            continue;
        }
        // A coordinate that moves nothing but its drive has a pivot of zero without it, and no equation.
        const bool by_zero = node.kind == operation::divide && links.is_zero(copy.of(node.b));
        const signed_node original{static_cast<int>(id), false};
        if (is_of_effect(node) || by_zero) {
            copy.replace(original, links.zero());
        } else {
            copy.of(original);
        }
    }
    for (const graph_output& out : model.outputs()) {
        if (out.array != "W" || is_of_link[static_cast<std::size_t>(out.index) % is_of_link.size()]) {
            links.output(out.array, out.index, copy.of(out.value));
        }
    }
    return count_operations(with_rewritten_sums(links));
}

}  // namespace idim::generator
