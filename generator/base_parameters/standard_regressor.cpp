#include "base_parameters/standard_regressor.hpp"

#include "base_parameters/constant_polynomial.hpp"
#include "dynamics/virtual_power.hpp"

namespace idim::generator {

standard_regressor build_standard_regressor(const kinematic_tree& tree, const standard_parameters& parameters) {
    const expression_graph graph = build_graph(virtual_power_model(tree, parameters), constants_as::symbols);
    return {graph, angle_relations(graph, constant_values(tree)), static_cast<std::size_t>(tree.dof()),
            parameters.all.size(), !tree.closures.empty()};
}

}  // namespace idim::generator
