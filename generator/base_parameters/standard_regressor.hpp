#pragma once

#include "base_parameters/angle_relations.hpp"
#include "dynamics/dynamic_models.hpp"
#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Regressor of all standard parameters as one row w = v' W_st [p], constants kept as symbols: v = unit vector i gives
/// row i of W_st, any other v a combination of its rows, with the same relations between the columns.
struct standard_regressor {
    expression_graph graph;  ///< output k is column k
    angle_relations angles;
    std::size_t dof = 0;
    std::size_t columns = 0;
    /// Closed loops bring roots of what positions make: a state may be where one does not close, and then has no value.
    bool has_roots = false;

    /// Whether the square root of a node is one of these.
    bool is_root(int node) const {
        return has_roots && graph.nodes()[static_cast<std::size_t>(node)].role <= symbol_role::position;
    }

    /// Place of v in the graph's symbols; all symbols before it are constants and signals.
    std::size_t first_virtual() const { return graph.symbols().size() - dof; }
};

standard_regressor build_standard_regressor(const kinematic_tree& tree, const standard_parameters& parameters);

}  // namespace idim::generator
