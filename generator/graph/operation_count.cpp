#include "graph/operation_count.hpp"

namespace idim::generator {

operation_count count_operations(const expression_graph& graph) {
    operation_count count;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < graph.nodes().size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (!live[id] || node.role <= symbol_role::parameter) {
            continue;
        }
        count.mul += node.kind == operation::multiply ? 1 : 0;
        count.add += node.kind == operation::add ? 1 : 0;
        count.div += node.kind == operation::divide ? 1 : 0;
        count.functions += node.kind == operation::function ? 1 : 0;
    }
    return count;
}

}  // namespace idim::generator
