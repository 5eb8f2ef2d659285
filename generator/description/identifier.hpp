#pragma once

#include <string>

#include "idim/input_error.hpp"

namespace idim::generator {

/// Names of a description end up in formulas, file names and source text, so they are refused here unless they are
/// [A-Za-z][A-Za-z0-9_]* of at most 64 characters and no keyword of C or C++ (nor a name such as `main` or `std` that a
/// generated file cannot declare). Throws input_error at `where`; returns `name`.
std::string checked_name(const std::string& name, const input_location& where);

/// The name that is nearest to `text` by these rules: other characters become underscores, `prefix` (a letter) comes
/// before what does not begin with a letter, and an underscore behind a name that has a meaning. Throws input_error at
/// `where` where the result is too long.
std::string nearest_name(const std::string& text, char prefix, const input_location& where);

/// A name that stands in expressions: constants, linear and shape coefficients. Besides the rules above it is none of
///   signals      q qd qdd t temp tau tau_rigid q_from qd_from qdd_from, and those of one joint: q1 qd1 qdd1 tau1 temp1
///   numbers      pi e i I
///   functions    sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt pow abs sign min max
///   the model    chi W Y M N and the rigid parameters XX XY XZ YY YZ ZZ MX MY MZ
///   parameters   a parameter of a link, regrouped or not: XX1 M3 Ia1 Fv2 Fc2 off4 ZZ1R ...
std::string checked_symbol(const std::string& name, const input_location& where);

}  // namespace idim::generator
