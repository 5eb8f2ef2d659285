#pragma once

#include <string>

#include "backend/manifest.hpp"

namespace idim::generator {

inline constexpr const char* manifest_name = "manifest.json";

/// Text of manifest.json: JSON with each joint, effect, constant and function on a line of its own, so that a change of
/// one is a change of one line.
std::string to_json_text(const manifest& content);

/// Reads it back; `file` is named in messages. Whoever wrote it is not trusted: throws input_error, naming the entry,
/// where one is missing or of another kind than expected, or where it belongs to another version of the format or of
/// the interface.
manifest read_manifest(const std::string& text, const std::string& file);

}  // namespace idim::generator
