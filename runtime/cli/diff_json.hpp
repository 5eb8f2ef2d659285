#pragma once

#include "command.hpp"
#include "model_comparison.hpp"

namespace idim::cli {

/// FORMATS.md, `idim diff --json`.
json to_json(const model_comparison& comparison);

}  // namespace idim::cli
