#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

namespace {

symbolic_model states_model(const kinematic_tree& tree, const standard_parameters& parameters, const std::string& array,
                            GiNaC::ex effect_memory::*value) {
    symbolic_model model(tree);
    declare_gates(model, parameters);
    declare_signals(model, parameters);
    declare_motion(model, tree, {});
    model.declare(parameters.step, {"dt", symbol_role::step, 0});
    for (std::size_t s = 0; s < parameters.states.size(); ++s) {
        const effect_memory& state = parameters.states[s];
        model.output(array, static_cast<int>(s), model.assign(array + "_" + state.name, state.*value));
    }
    return model;
}

}  // namespace

symbolic_model first_states_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                  const parameter_selection& /*selection*/, const model_form& /*form*/) {
    return states_model(tree, parameters, "start", &effect_memory::start);
}

symbolic_model next_states_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& /*selection*/, const model_form& /*form*/) {
    return states_model(tree, parameters, "next", &effect_memory::next);
}

}  // namespace idim::generator
