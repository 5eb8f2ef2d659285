#pragma once

#include <set>
#include <string>
#include <vector>

#include "backend/language.hpp"

namespace idim::generator {

/// Name of the argument that leaves of a role are read from: "q", "chi".
std::string argument_name(symbol_role role);

/// Prints a graph as statements of a language; `reserved` are names of the surroundings that variables must not hide.
///
/// Named nodes get a line of their own under that name; what is used more than once without a name is called after the
/// first named node that needs it ("U12_3_t1"), so that a change in one place renames nothing elsewhere; everything
/// else stands inside the expression that uses it. Parentheses keep the order of operations of the graph.
std::vector<std::string> print_body(const expression_graph& graph, const language& spelling,
                                    const std::set<std::string>& reserved, const element_names& names = {});

}  // namespace idim::generator
