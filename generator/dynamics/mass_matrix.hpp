#pragma once

#include <vector>

#include "dynamics/link_frame.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

/// Lower triangle of M, element (i, j) with j <= i, by composite rigid bodies (Walker and Orin 1982), effects included.
std::vector<std::vector<GiNaC::ex>> inertia_elements(symbolic_model& model, const kinematic_tree& tree,
                                                     const std::vector<link_frame>& frames,
                                                     const standard_parameters& parameters,
                                                     const parameter_values& values);

}  // namespace idim::generator
