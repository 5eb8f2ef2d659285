#pragma once

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Binary operations per evaluation: signs are free, x^2 is one multiplication, sines, cosines and the other functions
/// are counted apart, what depends on constants or parameters alone is computed once and not counted (the convention of
/// the symbolic robot modelling literature, e.g. Khalil and Dombre 2002, ch. 9).
struct operation_count {
    int mul = 0;
    int add = 0;
    int div = 0;
    int functions = 0;
};

operation_count count_operations(const expression_graph& graph);

}  // namespace idim::generator
