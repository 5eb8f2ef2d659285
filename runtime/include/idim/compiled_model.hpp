#pragma once

#include <memory>
#include <string>
#include <vector>

#include "idim/effect_interface.h"
#include "idim/law_interface.h"
#include "idim/model_interface.h"

namespace idim {

/// A source file of a generated model, in memory.
struct model_source {
    std::string name;  ///< relative, such as "regressor.hpp" or "idim/model_interface.h"
    std::string text;
};

/// A generated model, compiled by the system compiler and loaded into this process for as long as the object lives.
class compiled_model {
  public:
    explicit compiled_model(std::shared_ptr<void> library, const idim_model_interface* model)
        : library_(std::move(library)), model_(model) {}

    const idim_model_interface& interface() const { return *model_; }

  private:
    std::shared_ptr<void> library_;
    const idim_model_interface* model_;
};

/// Other generated or written code, compiled and loaded likewise: the table of functions that it exports.
template <class Table>
class compiled_table {
  public:
    explicit compiled_table(std::shared_ptr<void> library, const Table* table)
        : library_(std::move(library)), table_(table) {}

    const Table& table() const { return *table_; }

  private:
    std::shared_ptr<void> library_;
    const Table* table_;
};

using compiled_effects = compiled_table<idim_effect_table>;
using compiled_law = compiled_table<idim_law_table>;

/// Where and how models are compiled; every field has a default.
struct compile_options {
    std::string
        cache;  ///< folder; default $XDG_CACHE_HOME/idim, else $HOME/.cache/idim, else a private temporary folder
    std::string compiler;  ///< default $CXX, else the first of c++, g++, clang++ on the PATH
};

/// Compiles the .cpp files of `sources` into one shared object and loads it, or takes it from the cache.
///
/// A cache entry's key is the SHA-256 of all sources, the compiler's path and version and the flags. An entry is used
/// only if the folder and its files belong to this user and no one else may write them, its sources are these byte for
/// byte, the shared object's hash is the recorded one, and the loaded model has this ABI and `input_hash`; anything
/// else is rebuilt. Two processes may ask for the same entry at once. Throws std::runtime_error with the compiler's
/// message where it fails, or where there is no compiler.
compiled_model compile_model(const std::vector<model_source>& sources, const std::string& input_hash,
                             const compile_options& options = {});

/// The same for the source of generated effects, and for that of a control law (law_interface.h).
compiled_effects compile_effects(const std::vector<model_source>& sources, const compile_options& options = {});
compiled_law compile_law(const std::vector<model_source>& sources, const compile_options& options = {});

}  // namespace idim
