#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Cosines and sines of joint positions that several models read, each once, in the order in which they are met: they
/// depend on positions and constants alone, so that one evaluation serves all models at a state.
class shared_sines {
  public:
    /// The same model with these functions as leaves of role symbol_role::sine; a leaf's index is its place here.
    expression_graph taken_from(const expression_graph& model);

    int size() const { return static_cast<int>(values_.size()); }
    /// The functions at `places` from the positions: outputs "sc"[place].
    expression_graph graph(const std::set<int>& places) const;

  private:
    graph_symbol leaf(const expression_graph& model, signed_node function);

    expression_graph functions_;
    std::vector<signed_node> values_;
    std::vector<std::string> names_;
    std::map<int, int> place_;  ///< of a node of functions_
};

/// Places among the shared sines that a model reads.
std::set<int> sines_read(const expression_graph& model);

}  // namespace idim::generator
