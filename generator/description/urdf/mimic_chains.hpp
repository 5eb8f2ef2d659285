#pragma once

#include "description/urdf/urdf_tree.hpp"

namespace idim::generator {

/// Makes each joint that mimics one that mimics another follow the joint at the end of that chain, which is driven.
/// Throws input_error for joints that mimic each other and for a joint to follow that has not one axis.
void resolve_mimics(urdf_tree& tree);

}  // namespace idim::generator
