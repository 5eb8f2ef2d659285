#pragma once

#include <functional>

#include "dynamics/model_form.hpp"
#include "graph/cost_model.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// The forms in which a model may be written.
struct form_space {
    model_form start;            ///< what is cheapest for most robots
    bool parallel_axes = false;  ///< whether these may differ from `start`
    bool meeting = false;
    bool second_moments = false;  ///< tried where sums of parameters are not free
    bool merged = false;          ///< likewise: no link merged
};

using form_builder = std::function<expression_graph(const model_form&)>;

/// The model in the cheapest form that is found from `start` by changing one choice after the other, each kept where it
/// makes the model cheaper. Choices without meaning for the robot are not tried.
expression_graph in_cheapest_form(const kinematic_tree& tree, const form_space& space, cost_target target,
                                  const form_builder& build);

}  // namespace idim::generator
