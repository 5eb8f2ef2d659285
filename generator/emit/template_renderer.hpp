#pragma once

#include <string>
#include <vector>

#include "backend/template_context.hpp"

namespace idim::generator {

struct rendered_file {
    std::string name;  ///< relative to the model's folder
    std::string text;
};

/// Fills the templates of `folder` (templates/cpp): one header per model, metadata, and the interface for the
/// identifiers. Throws std::runtime_error for a template that cannot be read, is malformed, or names a key that the
/// context does not have.
std::vector<rendered_file> render_cpp(const template_context& context, const std::string& folder);

}  // namespace idim::generator
