#pragma once

#include <ginac/ginac.h>

#include <map>
#include <string>

#include "description/robot_description.hpp"

namespace idim::generator {

/// sign(x) of effect descriptions: -1, 0 or 1; kept symbolic, derivative zero.
DECLARE_FUNCTION_1P(sign)

/// Names an expression may use and what they stand for.
using named_values = std::map<std::string, GiNaC::ex>;

/// Reads an expression such as "q + pi/2", "l3z + l4" or "Fs*exp(-(qd/vs)^2)*sign(qd)".
/// Decimal numbers become exact rationals; `pi` is the constant; functions: sin cos tan exp log sqrt abs sign tanh
/// atan. Throws input_error for a malformed expression, an unknown name (listing the known ones), a pole, or a power
/// whose exponent is a number beyond 16.
GiNaC::ex parse_expression(const expression_text& source, const named_values& names);

/// Exact rational value of an expression without symbols; 60 digits where it is not rational. Throws input_error if it
/// is not a finite real number.
GiNaC::numeric constant_value(const GiNaC::ex& expression, const input_location& where);

}  // namespace idim::generator
