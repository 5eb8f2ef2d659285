#include "base_parameters/standard_regressor.hpp"

namespace idim::generator {

standard_regressor build_standard_regressor(const kinematic_tree& tree, const standard_parameters& parameters) {
    parameter_selection all;
    for (std::size_t p = 0; p < parameters.all.size(); ++p) {
        all.kept.push_back(p);
        all.names.push_back(parameters.all[p].name);
    }
    standard_regressor result;
    result.graph = build_graph(regressor_model(tree, parameters, all), constants_as::symbols);
    result.dof = tree.dof();
    result.columns = static_cast<int>(parameters.all.size());
    for (const graph_output& out : result.graph.outputs()) {
        result.row_of_output.push_back(out.index / result.columns);
        result.column_of_output.push_back(out.index % result.columns);
    }
    return result;
}

}  // namespace idim::generator
