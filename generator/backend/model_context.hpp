#pragma once

#include <string>

#include "backend/language.hpp"
#include "backend/template_context.hpp"
#include "base_parameters/base_parameter_set.hpp"
#include "description/effect_description.hpp"
#include "description/robot_description.hpp"
#include "graph/cost_model.hpp"

namespace idim::generator {

/// Operations of the four models users compare generators by.
struct model_operations {
    operation_count inverse_dynamics, regressor, mass_matrix, forward_dynamics;
};

/// Those of the robot as declared, and without its effects.
struct operation_counts {
    model_operations declared, rigid;
};

/// Everything derived for one robot.
struct robot_model {
    robot_description description;
    std::vector<effect_description> effects;  ///< one per description.effects
    kinematic_tree tree;
    standard_parameters parameters;
    base_parameter_set base;
};

/// The constants a description names, in its order, with their values.
std::vector<std::pair<std::string, double>> named_constants(const robot_model& model);

/// What is written at the head of every file.
struct file_origin {
    std::string version, input_hash;
    cost_target cost = cost_target::operations;  ///< what the forms of the models were chosen for
};

/// Derives all models of a robot, with `derivatives` also those of its inverse dynamics, and spells them for the
/// templates. `operations` receives the counts.
template_context build_context(const robot_model& model, const file_origin& origin, bool derivatives,
                               const languages& spellings, operation_counts& operations);

}  // namespace idim::generator
