#pragma once

#include <string>

#include "undeclared/arm.hpp"

namespace idim::undeclared {

/// The arm's true standard parameters as a YAML map, XX1 .. M1, Ia1, Fv1, Fc1, off1, XX2 ..: inertia about the origin
/// of the link's frame and first moments.
std::string standard_parameters_text(const arm& robot);

}  // namespace idim::undeclared
