#pragma once

#include <memory>
#include <string>

namespace idim {

/// Loads a shared object from memory, symbols resolved at once and kept to itself; what is loaded are these bytes, even
/// if the file they came from changes meanwhile. The handle is one for dlsym, unloaded with its last copy.
/// Throws std::runtime_error with the loader's message.
std::shared_ptr<void> load_library(const std::string& bytes);

}  // namespace idim
