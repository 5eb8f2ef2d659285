#pragma once

#include <string>

#include "comparison/model_summary.hpp"
#include "idim/compiled_model.hpp"

namespace idim::cli {

/// One side of a comparison, compiled and loaded.
struct compared_model {
    std::string path;  ///< as the user gave it
    generator::model_summary summary;
    compiled_model compiled;
};

/// Takes a folder that `idim generate` wrote as it stands there, and anything else as a robot description. The code of
/// a folder is compiled and run, as a build would. Throws input_error, also where that code cannot be used.
compared_model load_compared(const std::string& path);

}  // namespace idim::cli
