#pragma once

#include "backend/manifest.hpp"
#include "backend/model_context.hpp"

namespace idim::generator {

/// The manifest of a robot's models, but for its list of files.
manifest describe(const robot_model& model, const template_context& context);

}  // namespace idim::generator
