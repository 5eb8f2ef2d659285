#pragma once

#include "description/urdf/urdf_skeleton.hpp"

namespace idim::generator {

/// Reads what urdfdom makes of the document into the links and joints of its skeleton: inertias, types of joints,
/// origins, axes, limits, damping and friction, and which joint each mimics. Throws input_error for what urdfdom
/// refuses and for values that cannot be.
void read_values(const xml_element& root, urdf_skeleton& skeleton);

}  // namespace idim::generator
