#include "graph/shared_sines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "graph/graph_copy.hpp"

namespace idim::generator {

namespace {

/// Marks the nodes that depend on joint positions and constants alone.
std::vector<bool> known_from_positions(const expression_graph& graph) {
    std::vector<bool> known(graph.nodes().size(), false);
    for (std::size_t id = 0; id < known.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        const bool is_leaf = node.kind == operation::constant || node.kind == operation::symbol;
        const auto is_known = [&known](signed_node n) { return known[static_cast<std::size_t>(n.id)]; };
        known[id] = is_leaf ? node.role == symbol_role::constant || node.role == symbol_role::position
                            : is_known(node.a) && is_known(node.b);
    }
    return known;
}

bool is_sine(const graph_node& node) {
    return node.kind == operation::function &&
           (node.function == function_kind::sin || node.function == function_kind::cos);
}

}  // namespace

graph_symbol shared_sines::leaf(const expression_graph& model, signed_node function) {
    const signed_node angle = graph_copy(model, functions_).of(model[function].a);
    const signed_node value = functions_.function(model[function].function, angle);
    const auto [at, fresh] = place_.try_emplace(value.id, size());
    if (fresh) {
        values_.push_back(value);
        const std::string& name = model[function].name;
        const bool is_free = !name.empty() && std::find(names_.begin(), names_.end(), name) == names_.end();
        names_.push_back(is_free ? name : fmt::format("sc{}", at->second));
    }
    return {names_[static_cast<std::size_t>(at->second)], symbol_role::sine, at->second};
}

expression_graph shared_sines::taken_from(const expression_graph& model) {
    expression_graph result;
    result.reserve(model.nodes().size());
    graph_copy copy(model, result);
    const std::vector<bool> live = model.live();
    const std::vector<bool> known = known_from_positions(model);
    for (std::size_t id = 0; id < live.size(); ++id) {
        const signed_node node{static_cast<int>(id), false};
        if (live[id] && is_sine(model[node]) && known[id] && model[node].role == symbol_role::position) {
            copy.replace(node, result.symbol(leaf(model, node)));
        } else if (live[id]) {
            copy.of(node);
        }
    }
    for (const graph_output& out : model.outputs()) {
        result.output(out.array, out.index, copy.of(out.value));
    }
    return result;
}

expression_graph shared_sines::graph(const std::set<int>& places) const {
    expression_graph result;
    graph_copy copy(functions_, result);
    for (const int place : places) {
        result.output("sc", place, copy.of(values_[static_cast<std::size_t>(place)]));
    }
    return result;
}

std::set<int> sines_read(const expression_graph& model) {
    std::set<int> places;
    const std::vector<bool> live = model.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = model.nodes()[id];
        if (live[id] && node.kind == operation::symbol && node.role == symbol_role::sine) {
            places.insert(model.symbols()[static_cast<std::size_t>(node.symbol)].index);
        }
    }
    return places;
}

}  // namespace idim::generator
