#pragma once

#include <vector>

#include "dynamics/inverse_dynamics.hpp"

namespace idim::generator {

/// Lower triangle of M, element (i, j) with j <= i, by composite rigid bodies (Walker and Orin 1982), effects included.
/// The frame's form merges all joints.
std::vector<std::vector<GiNaC::ex>> inertia_elements(model_frame& frame, const standard_parameters& parameters);

}  // namespace idim::generator
