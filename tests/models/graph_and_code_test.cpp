// Same model, two roads: the expression graph evaluated in place in every form of the equations, and the code printed
// from the cheapest of them, compiled and called.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "backend/model_context.hpp"
#include "dynamics/dynamic_models.hpp"
#include "graph/evaluate.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

/// A namespace of its own: the names of the generator that it takes in are for this file alone.
namespace idim::test::graph_and_code {

namespace {

using namespace idim::generator;
using builder = symbolic_model (*)(const kinematic_tree&, const standard_parameters&, const parameter_selection&,
                                   const model_form&);

/// The stages of generate() up to the graph.
struct staged_robot {
    explicit staged_robot(const std::string& name) {
        const robot_description description = read_robot(robot_file(name));
        std::vector<effect_description> effects;
        for (const effect_use& use : description.effects) {
            effects.push_back(find_effect(use, description, templates_folder + "/effects"));
        }
        tree = build_kinematic_tree(description);
        parameters = list_parameters(tree, description.effects, effects);
        selection = find_base_parameters(tree, parameters).selection();
    }

    kinematic_tree tree;
    standard_parameters parameters;
    parameter_selection selection;
};

/// Arguments of the models by role.
struct arguments {
    joint_state state;
    Eigen::VectorXd tau, chi;

    double of(const graph_symbol& symbol) const {
        switch (symbol.role) {
            case symbol_role::position:
                return state.q[symbol.index];
            case symbol_role::velocity:
                return state.qd[symbol.index];
            case symbol_role::acceleration:
                return state.qdd[symbol.index];
            case symbol_role::torque:
                return tau[symbol.index];
            case symbol_role::parameter:
                return chi[symbol.index];
            default:
                throw std::logic_error("no value of " + symbol.name);
        }
    }
};

/// Elements of one output array of a graph.
Eigen::VectorXd evaluated(const expression_graph& graph, const arguments& given, const std::string& array,
                          Eigen::Index size) {
    std::vector<double> leaves;
    for (const graph_symbol& symbol : graph.symbols()) {
        leaves.push_back(given.of(symbol));
    }
    double_arithmetic arithmetic;
    const std::vector<double> values = evaluate(graph, leaves, arithmetic);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size);
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (graph.outputs()[k].array == array) {
            result[graph.outputs()[k].index] = values[k];
        }
    }
    return result;
}

Eigen::VectorXd by_rows(const Eigen::MatrixXd& m) {
    return m.transpose().reshaped();
}

std::vector<model_form> all_forms() {
    std::vector<model_form> forms;
    for (const auto merged : {model_form::merging::none, model_form::merging::tips, model_form::merging::all}) {
        for (int bits = 0; bits < 8; ++bits) {
            forms.push_back({merged, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0});
        }
    }
    return forms;
}

class GraphAndCode : public testing::TestWithParam<std::string> {};

TEST_P(GraphAndCode, HaveTheSameValuesInEveryForm) {
    const staged_robot staged(GetParam());
    const test_model compiled(robot_file(GetParam()));
    const Eigen::Index n = compiled.dof();
    const Eigen::Index b = compiled.n_base();
    // Some hundred operations in another order: rounding differs by parts in 1e15, more where terms cancel.
    constexpr double rounding = 1e-11;
    for (const model_form& form : all_forms()) {
        SCOPED_TRACE(testing::Message() << "merged " << static_cast<int>(form.merged) << ", second moments "
                                        << form.second_moments << ", parallel axes " << form.parallel_axes
                                        << ", meeting " << form.meeting);
        const auto graph = [&](builder build) {
            return build_graph(build(staged.tree, staged.parameters, staged.selection, form), constants_as::values);
        };
        const expression_graph W = graph(regressor_model), tau = graph(inverse_dynamics_model),
                               M = graph(mass_matrix_model), N = graph(bias_model), G = graph(gravity_model),
                               qdd = graph(forward_dynamics_model);
        std::mt19937_64 random(12);
        for (int k = 0; k < 10; ++k) {
            arguments given{random_state(n, random), {}, {}};
            given.tau = 10.0 * given.state.qdd;
            given.chi =
                Eigen::VectorXd::NullaryExpr(b, [&] { return std::uniform_real_distribution<>(0.5, 1.5)(random); });
            const joint_state& s = given.state;
            EXPECT_LE(deviation(by_rows(compiled.regressor(s)), evaluated(W, given, "W", n * b)), rounding);
            EXPECT_LE(deviation(compiled.inverse_dynamics(s, given.chi), evaluated(tau, given, "tau", n)), rounding);
            EXPECT_LE(deviation(by_rows(compiled.mass_matrix(s.q, given.chi)), evaluated(M, given, "M", n * n)),
                      rounding);
            EXPECT_LE(deviation(compiled.bias(s, given.chi), evaluated(N, given, "N", n)), rounding);
            EXPECT_LE(deviation(compiled.gravity(s.q, given.chi), evaluated(G, given, "G", n)), rounding);
            int pivot = 0;  // these parameters are no robot's, so that any pivot may be negative
            EXPECT_LE(
                deviation(compiled.forward_dynamics(s, given.tau, given.chi, pivot), evaluated(qdd, given, "qdd", n)),
                1e-9);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Robots, GraphAndCode,
                         testing::Values("scara", "emps", "stanford", "tx40", "panda", "denso_vp6242g"),
                         [](const testing::TestParamInfo<std::string>& robot) { return robot.param; });

}  // namespace

}  // namespace idim::test::graph_and_code
