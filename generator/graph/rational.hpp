#pragma once

#include <cln/rational.h>

#include <string>

namespace idim::generator {

/// Exact number: every constant of a model stays one until it is printed.
using rational = cln::cl_RA;

/// Nearest double.
double to_double(const rational& value);

/// Decimal text that reads back as the nearest double ("0.25", "1e-05", "-3").
std::string to_decimal(const rational& value);

/// Exact text: "21/100", "-3".
std::string to_fraction(const rational& value);

}  // namespace idim::generator
