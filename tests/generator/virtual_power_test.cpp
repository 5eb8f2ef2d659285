// The row of the standard regressor at virtual velocities, from its own recursion, against the rows of the regressor.
#include "dynamics/virtual_power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "base_parameters/standard_regressor.hpp"
#include "description/effect_description.hpp"
#include "graph/evaluate.hpp"
#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

struct robot {
    kinematic_tree tree;
    standard_parameters parameters;
};

robot read(const std::string& file) {
    const robot_description description = read_robot(file);
    std::vector<effect_description> effects;
    for (const effect_use& use : description.effects) {
        effects.push_back(find_effect(use, description, test::templates_folder + "/effects"));
    }
    robot result;
    result.tree = build_kinematic_tree(description);
    result.parameters = list_parameters(result.tree, description.effects, effects);
    return result;
}

robot read_robot_text(const std::string& text) {
    const test::temporary_folder folder;
    return read(folder.write("robot.yaml", text));
}

/// Values of q, qd, qdd and v: for symbols of both graphs by name.
double value(const graph_symbol& symbol, const std::map<std::string, double>& values) {
    return values.at(symbol.name);
}

std::vector<double> evaluated(const expression_graph& graph, const std::map<std::string, double>& values) {
    std::vector<double> leaves;
    for (const graph_symbol& symbol : graph.symbols()) {
        leaves.push_back(value(symbol, values));
    }
    double_arithmetic arithmetic;
    return evaluate(graph, leaves, arithmetic);
}

void expect_weighted_rows(const robot& of) {
    parameter_selection all;
    for (std::size_t p = 0; p < of.parameters.all.size(); ++p) {
        all.kept.push_back(p);
        all.names.push_back(of.parameters.all[p].name);
    }
    const expression_graph power = build_graph(virtual_power_model(of.tree, of.parameters), constants_as::values);
    const expression_graph W = build_graph(regressor_model(of.tree, of.parameters, all, {}), constants_as::values);
    const auto columns = static_cast<int>(all.kept.size());
    std::mt19937_64 random(21);
    for (int k = 0; k < 10; ++k) {
        std::map<std::string, double> values;
        for (const graph_symbol& symbol : power.symbols()) {
            values[symbol.name] = std::uniform_real_distribution<double>(-2.0, 2.0)(random);
        }
        std::vector<double> expected(all.kept.size(), 0.0);
        std::vector<double> size(all.kept.size(), 0.0);
        const std::vector<double> rows = evaluated(W, values);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const graph_output& out = W.outputs()[i];
            const double term = values.at("v" + std::to_string(out.index / columns + 1)) * rows[i];
            expected[static_cast<std::size_t>(out.index % columns)] += term;
            size[static_cast<std::size_t>(out.index % columns)] += std::abs(term);
        }
        const std::vector<double> found = evaluated(power, values);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t p = 0; p < found.size(); ++p) {
            // Rounding of two different orders of some hundred operations, whose terms may cancel.
            EXPECT_NEAR(found[p], expected[p], 1e-11 * (1.0 + size[p])) << all.names[p];
        }
    }
}

/// A chain whose rows repeat every six joints.
std::string repeating_chain(int joints) {
    std::string text = "name: chain\njoints:\n";
    const char* const alpha[] = {"0", "pi/2", "-pi/2"};
    for (int i = 1; i <= joints; ++i) {
        text += "  - {name: j" + std::to_string(i) + ", alpha: " + alpha[i % 3] +
                ", d: 0.1, theta: q, r: " + (i % 2 == 0 ? "0.05" : "0") + "}\n";
    }
    return text;
}

/// Operations of one row of the standard regressor.
std::size_t operations(int joints) {
    const robot of = read_robot_text(repeating_chain(joints));
    const standard_regressor W = build_standard_regressor(of.tree, of.parameters);
    return graph_evaluator<double>(W.graph, double_arithmetic::number).size();
}

class VirtualPower : public testing::TestWithParam<std::string> {};

TEST_P(VirtualPower, IsTheSumOfTheRegressorsRowsTimesTheVirtualVelocities) {
    expect_weighted_rows(read(test::robot_file(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Robots, VirtualPower, testing::ValuesIn(test::robot_names()),
                         [](const testing::TestParamInfo<std::string>& name) { return name.param; });

TEST(VirtualPowerOfATree, IsTheSumOfTheRegressorsRowsTimesTheVirtualVelocities) {
    expect_weighted_rows(read_robot_text(
        "name: tree\nconstants: {L: 0.3, a: 0.4}\ngravity: [1, -2, -9.81]\njoints:\n"
        "  - {name: j1, gamma: 0.3, b: L, alpha: a, theta: q, r: 0.3}\n"
        "  - {name: j2, alpha: pi/2, d: 0.1, theta: 2*q + 0.5}\n"
        "  - {name: j3, d: 0.4, theta: q - q_j2, r: 0.05}\n"
        "  - {name: j4, antecedent: j1, type: prismatic, gamma: pi/3, alpha: -pi/2, d: 0.2, theta: 0.7, r: q}\n"
        "  - {name: j5, type: fixed, alpha: 0.6, d: 0.1, theta: 0.3, massless: true}\n"
        "  - {name: j6, alpha: pi/2, theta: -q, r: L}\n"
        "effects: [rotor_inertia, viscous_friction, coulomb_friction, torque_offset]\n"));
}

TEST(VirtualPower, TakesAsManyOperationsForEveryFurtherLink) {
    // Once all components of the motion are there, six links of a period cost the same wherever they stand.
    EXPECT_EQ(operations(24) - operations(18), operations(18) - operations(12));
    EXPECT_GT(operations(18), operations(12));
}

}  // namespace

}  // namespace idim::generator
