#pragma once

#include "idim/input_error.hpp"

namespace idim::generator {

/// The number itself. Throws input_error for one beyond 1e9, which has no meaning for a robot: products of such numbers
/// may not be representable.
double bounded(double value, const input_location& where);

/// The same for a quantity that is zero or more; `what` names it.
double not_negative(double value, const input_location& where, const char* what);

}  // namespace idim::generator
