#pragma once

#include <string>
#include <vector>

#include "backend/template_context.hpp"
#include "emit/context_data.hpp"

namespace idim::generator {

/// What every template may use; `partials` are those of its folder.
context_data robot_values(const template_context& context, const std::string& folder,
                          const std::vector<std::string>& partials);

/// What a template of all functions may use beside.
context_data values_of_functions(const std::vector<function_context>& functions);

/// What a template of one function may use beside, over one scalar type.
context_data values_of_function(const function_context& function, const variant_context& variant);

}  // namespace idim::generator
