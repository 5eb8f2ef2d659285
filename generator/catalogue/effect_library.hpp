#pragma once

#include <string>
#include <vector>

#include "emit/template_renderer.hpp"

namespace idim::generator {

/// The effects a residual may be traced to, as code: those in `templates`/effects and those beside the robot
/// description, which come before one of the same name. One C++ source that exports idim_effects()
/// (idim/effect_interface.h), and the hash of what it depends on.
struct effect_library {
    std::vector<rendered_file> files;
    std::string input_hash;
};

/// Throws input_error for a malformed effect file.
effect_library generate_effects(const std::string& robot_file, const std::string& templates);

}  // namespace idim::generator
