#pragma once

#include "backend/template_context.hpp"
#include "emit/context_data.hpp"

namespace idim::generator {

/// Sets what the models read beside the motion, as the code around them spells it.
void set_signals(context_data& values, const template_context& context);

}  // namespace idim::generator
