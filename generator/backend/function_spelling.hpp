#pragma once

#include <string>
#include <vector>

#include "backend/language.hpp"
#include "backend/template_context.hpp"
#include "graph/expression_graph.hpp"

namespace idim::generator {

/// A model before it is spelled.
struct model_function {
    std::string name;
    std::string summary;
    std::vector<function_argument> arguments;
    expression_graph graph;
};

struct spelled_models {
    std::vector<function_context> functions;  ///< the models, then `sines`
    int sines = 0;                            ///< elements of the array sc
};

/// Spells models in every scalar type of a target. A model that reads cosines or sines of joint positions becomes two
/// functions: one whose name ends in _sc takes them as an argument behind q, the other evaluates those it needs and
/// calls it. The function `sines` evaluates all of them; it has no routines where there are none.
spelled_models spell(const std::vector<model_function>& models, const element_names& names, const languages& spellings);

}  // namespace idim::generator
