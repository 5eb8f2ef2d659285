#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"

namespace idim::generator {

symbolic_model closure_model(const kinematic_tree& tree, const standard_parameters& /*parameters*/,
                             const parameter_selection& /*selection*/, const model_form& /*form*/) {
    symbolic_model model(tree);
    declare_motion(model, tree, {false, false, false});
    for (std::size_t i = 0; i < tree.closures.size(); ++i) {
        model.output("closed", static_cast<int>(i), tree.closures[i]);
    }
    return model;
}

}  // namespace idim::generator
