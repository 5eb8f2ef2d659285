#pragma once

#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// What code is chosen to be cheap for.
///  - operations: additions, multiplications and divisions as the literature counts them (operation_count.hpp)
///  - x86: a processor that executes many instructions at once and fuses a product into a sum. A form is ranked by half
///    a cycle an instruction plus four cycles an operation on the longest chain: the first bounds what many calls take,
///    the second what one takes.
///  - mcu: a Cortex-M4F, which executes in order: a cycle an operation, 14 a division (a fused product takes as long
///    as two operations), two for each value that is loaded because it is not among the registers, one to store it.
/// The latter two count what depends on parameters alone too, since code evaluates it at each call.
enum class cost_target { operations, x86, mcu };

/// Names of all targets in the order of the enumeration, the default first: ops, x86, mcu.
const std::vector<std::string>& cost_target_names();
/// Throws std::invalid_argument for a name that is none of these.
cost_target cost_target_of(const std::string& name);
std::string to_string(cost_target target);

/// Cost of one evaluation: operations, or half cycles. Functions are left out: all forms of a model call the same.
int cost(const expression_graph& graph, cost_target target);

}  // namespace idim::generator
