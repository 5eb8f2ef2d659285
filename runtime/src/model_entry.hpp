#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "idim/compiled_model.hpp"
#include "system_compiler.hpp"

namespace idim {

// An entry is a folder that holds the sources of a model, model.so compiled from them, and model.sha256, its hash;
// model.exports tells the linker that idim_model is all that is seen of it.

/// Throws std::logic_error unless every source is named by a plain path inside the folder, none twice, none as the
/// entry's own files, and one is a .cpp file.
void require_source_names(const std::vector<model_source>& sources);

/// The name of the entry: SHA-256 over sources, compiler, its version, flags, exported symbols and IDIM_MODEL_ABI, each
/// with its length.
std::string entry_key(const std::vector<model_source>& sources, const system_compiler& compiler);

/// Fills the empty folder `entry`. Throws std::system_error if it cannot be written, std::runtime_error if the sources
/// do not compile.
void build_entry(const std::filesystem::path& entry, const std::vector<model_source>& sources,
                 const system_compiler& compiler);

/// The bytes of model.so. Throws std::runtime_error if a folder or file is not trusted, a source differs or the hash is
/// not the recorded one.
std::string read_entry(const std::filesystem::path& entry, const std::vector<model_source>& sources);

}  // namespace idim
