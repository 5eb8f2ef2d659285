#pragma once

#include <string>
#include <vector>

#include "emit/template_renderer.hpp"

namespace idim::generator {

/// Writes the files whose bytes differ from what stands in `folder`, each by renaming a temporary, and removes files
/// that an earlier manifest.json there lists and this one does not. Returns the names of what changed. Throws
/// input_error where the folder cannot be written.
std::vector<std::string> write_model(const std::vector<rendered_file>& files, const std::string& folder);

/// One line for each file of `folder` that is not what would be written: changed, missing or left over.
std::vector<std::string> compare_model(const std::vector<rendered_file>& files, const std::string& folder);

}  // namespace idim::generator
