#pragma once

#include <string>

namespace idim::generator {

/// First 16 hexadecimal digits of the SHA-256 of a text.
std::string content_hash(const std::string& text);

}  // namespace idim::generator
