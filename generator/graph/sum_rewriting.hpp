#pragma once

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// The same values with fewer operations: sums that nothing else needs are joined with the sums they are terms of, and
/// in each of the longer sums
///  - what depends on parameters alone is added up first, where it is computed once: p + (q + x) = (p + q) + x;
///  - products with a common factor that nothing else needs become one: a b + a c = a (b + c).
/// The order of terms stays otherwise.
expression_graph with_rewritten_sums(const expression_graph& graph);

}  // namespace idim::generator
