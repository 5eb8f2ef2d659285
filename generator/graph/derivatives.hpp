#pragma once

#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Derivatives by the `size` leaves of one role, such as q[0] .. q[n-1].
struct derivative_array {
    std::string name;  ///< of the output array, row-major: row = output of the model, column = leaf
    symbol_role by = symbol_role::position;
    int size = 0;
};

/// The partial derivatives of the outputs of a model that has one output array, as expressions over the leaves of the
/// model. Its intermediates are shared with and between the derivatives. Derived outwards from the leaves (forward
/// mode, a sweep for each leaf) and inwards from the outputs (reverse mode, a sweep for each output), and the one with
/// fewer operations taken. Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, ch. 3.
///
/// sign(x) has derivative 0 and abs(x) has sign(x), also at 0, where neither has one. The logarithm of the base of a
/// power is evaluated only where its exponent varies.
expression_graph differentiate(const expression_graph& model, const std::vector<derivative_array>& wanted);

}  // namespace idim::generator
