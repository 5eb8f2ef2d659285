#pragma once

#include "dynamics/dynamic_models.hpp"
#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Regressor of all standard parameters, constants kept as symbols.
struct standard_regressor {
    expression_graph graph;
    int dof = 0;
    int columns = 0;
    std::vector<int> row_of_output, column_of_output;  ///< place of each graph output in W_st [n x columns]
};

standard_regressor build_standard_regressor(const kinematic_tree& tree, const standard_parameters& parameters);

}  // namespace idim::generator
