#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Name of the argument that leaves of a role are read from: "q", "chi".
std::string argument_name(symbol_role role);

/// How an element of an argument array is written, such as "chi[base_index::ZZ1R]" for chi and 3.
using element_printer = std::function<std::string(const std::string& array, int index)>;

/// "chi[3]".
std::string numbered_element(const std::string& array, int index);

/// Prints a graph as C++ statements over a type `Scalar`.
///
/// Named nodes get a line of their own under that name; what is used more than once without a name is called after the
/// first named node that needs it ("U12_3_t1"), so that a change in one place renames nothing elsewhere; everything
/// else stands inside the expression that uses it. Parentheses keep the order of operations of the graph.
std::vector<std::string> print_cpp(const expression_graph& graph, const std::set<std::string>& reserved,
                                   const element_printer& element = numbered_element);

}  // namespace idim::generator
