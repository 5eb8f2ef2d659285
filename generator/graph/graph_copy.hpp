#pragma once

#include <optional>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Copies nodes of one graph, with all that they need, into another: node by node through the functions that build a
/// graph, so that the copy is simplified and shared as if it had been built there.
class graph_copy {
  public:
    graph_copy(const expression_graph& from, expression_graph& to)
        : from_(from), to_(to), known_(from.nodes().size()) {}

    /// The copy of a value.
    signed_node of(signed_node value);
    /// From now on `copy` stands for a node of the original.
    void replace(signed_node original, signed_node copy) {
        known_[static_cast<std::size_t>(original.id)] = original.negative ? -copy : copy;
    }

  private:
    signed_node build(const graph_node& node);

    const expression_graph& from_;
    expression_graph& to_;
    std::vector<std::optional<signed_node>> known_;  ///< by the original's id
};

}  // namespace idim::generator
