#pragma once

#include <string>

#include "description/effect_description.hpp"
#include "kinematics/expression_parser.hpp"

namespace idim::generator {

/// A decimal number as written, exactly.
GiNaC::ex exact_decimal(double value, const input_location& where);

/// The value a robot gives to a shape of an effect. Throws input_error where it gives none.
double shape_value(const effect_use& use, const effect_description& effect, const std::string& shape);

/// Throws input_error for a shape that the effect does not have.
void check_shapes(const effect_use& use, const effect_description& effect);

}  // namespace idim::generator
