#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backend/manifest.hpp"
#include "emit/template_renderer.hpp"

namespace idim::generator {

/// Writes the files whose bytes differ from what stands in `folder`, each by renaming a temporary, and removes files
/// that an earlier manifest.json there lists and this one does not. Returns the names of what changed. Throws
/// input_error where the folder cannot be written.
std::vector<std::string> write_model(const std::vector<rendered_file>& files, const std::string& folder);

/// A file of a folder that is not what would be written.
struct folder_difference {
    std::string name;
    std::optional<std::string> present;  ///< nothing where it is missing
    std::optional<std::string> wanted;   ///< nothing where it is left over from another model

    /// "differs", "missing" or "left over".
    std::string state() const;
};

/// Every file of `folder` that write_model would change.
std::vector<folder_difference> compare_model(const std::vector<rendered_file>& files, const std::string& folder);

/// A folder as write_model left it.
struct model_folder {
    manifest content;
    std::vector<rendered_file> files;  ///< those the manifest lists
};

/// Reads a folder of generated code. Whoever wrote it is not trusted: throws input_error where there is no manifest of
/// this version, or a file it lists is missing, too large (64 MiB) or none of this folder.
model_folder read_model(const std::string& folder);

}  // namespace idim::generator
