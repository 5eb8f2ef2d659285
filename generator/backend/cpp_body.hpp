#pragma once

#include <set>
#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Name of the argument that leaves of a role are read from: "q", "chi".
std::string argument_name(symbol_role role);

/// Prints a graph as C++ statements over a type `Scalar`.
///
/// Named nodes get a line of their own under that name; what is used more than once without a name is called after the
/// first named node that needs it ("U12_3_t1"), so that a change in one place renames nothing elsewhere; everything
/// else stands inside the expression that uses it. Parentheses keep the order of operations of the graph.
std::vector<std::string> print_cpp(const expression_graph& graph, const std::set<std::string>& reserved);

}  // namespace idim::generator
