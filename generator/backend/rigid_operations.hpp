#pragma once

#include <vector>

#include "graph/expression_graph.hpp"
#include "graph/operation_count.hpp"

namespace idim::generator {

/// Operations of a model of the links alone: that of the robot with its effects, in which the base parameters that
/// belong to effects are zero. `is_of_link` says of each base parameter whether it is there without effects; columns of
/// a regressor (output array "W") for the others are left out.
operation_count rigid_operations(const expression_graph& model, const std::vector<bool>& is_of_link);

}  // namespace idim::generator
