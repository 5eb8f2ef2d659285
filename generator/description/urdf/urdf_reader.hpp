#pragma once

#include <string>

#include "description/urdf/urdf_tree.hpp"

namespace idim::generator {

/// Reads a URDF file with urdfdom. Angles of origins that are a multiple of pi/2 rounded or cut off to the decimals
/// they are written with (four at least) become that multiple. What shows or collides (visual, collision),
/// transmissions and extensions are passed over. Refused with input_error, before urdfdom sees the file: more than 16
/// MB, 2000 links, 100 000 elements, 32 levels or 64 attributes of an element, document types (entities), XML that is
/// not well formed; and then links or joints that form no tree, mimic joints that follow each other, values that cannot
/// be.
urdf_tree read_urdf(const std::string& file);

}  // namespace idim::generator
