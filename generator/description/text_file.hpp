#pragma once

#include <cstddef>
#include <string>

namespace idim::generator {

/// The text of a file of at most `largest` bytes, which are whole megabytes (10^6). Refused with input_error: folders,
/// unreadable files, larger ones (nothing beyond the limit is read), control characters other than tab and line ends.
std::string read_text_file(const std::string& file, std::size_t largest);

}  // namespace idim::generator
