#include "backend/model_context.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "backend/cpp_body.hpp"
#include "dynamics/dynamic_models.hpp"

namespace idim::generator {

namespace {

using model_builder =
    std::function<symbolic_model(const kinematic_tree&, const standard_parameters&, const parameter_selection&)>;

/// A generated function before it is derived.
struct function_plan {
    std::string name;
    std::string summary;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
    model_builder build;
};

std::vector<function_plan> plans() {
    return {
        {"regressor",
         "Regressor of the base parameters: tau = W(q, qd, qdd) chi.",
         {"q", "qd", "qdd", "t", "temp"},
         {"W"},
         regressor_model},
        {"inverse_dynamics",
         "Inverse dynamic model: tau = M(q) qdd + N(q, qd).",
         {"q", "qd", "qdd", "t", "temp", "chi"},
         {"tau"},
         inverse_dynamics_model},
        {"mass_matrix", "Inertia matrix of the robot with its drives.", {"q", "chi"}, {"M"}, mass_matrix_model},
        {"bias",
         "Torque at zero acceleration: centrifugal, Coriolis, gravity, friction and other effects.",
         {"q", "qd", "t", "temp", "chi"},
         {"N"},
         bias_model},
        {"gravity", "Torque that holds the rigid links at rest.", {"q", "chi"}, {"G"}, gravity_model},
        {"forward_dynamics",
         "Direct dynamic model: qdd = M(q)^-1 (tau - N(q, qd)), by M = L' D L.",
         {"q", "qd", "tau", "t", "temp", "chi"},
         {"qdd", "D"},
         forward_dynamics_model},
    };
}

std::map<std::string, std::string> meanings(int n, std::size_t b) {
    return {
        {"q", fmt::format("q [{}] joint positions [rad or m]", n)},
        {"qd", fmt::format("qd [{}] joint velocities [rad/s or m/s]", n)},
        {"qdd", fmt::format("qdd [{}] joint accelerations [rad/s^2 or m/s^2]", n)},
        {"tau", fmt::format("tau [{}] joint torques or forces, joint side [N*m or N]", n)},
        {"t", "t time [s]"},
        {"temp", fmt::format("temp [{}] joint temperatures [degC]", n)},
        {"chi", fmt::format("chi [{}] base parameters, in the order of base_parameter_names", b)},
        {"W", fmt::format("W [{} x {}] row-major, row = joint, column = base parameter", n, b)},
        {"M", fmt::format("M [{} x {}] symmetric", n, n)},
        {"N", fmt::format("N [{}] joint torques or forces [N*m or N]", n)},
        {"G", fmt::format("G [{}] joint torques or forces [N*m or N]", n)},
        {"D", fmt::format("D [{}] pivots, all positive if and only if M is positive definite", n)},
        {"standard", "standard [standard_parameters] standard parameters, in the order of standard_parameter_names"},
    };
}

std::vector<argument_context> arguments(const function_plan& plan, const robot_model& model) {
    const auto meaning = meanings(model.tree.dof(), model.base.parameters.size());
    std::vector<argument_context> result;
    for (const std::string& name : plan.inputs) {
        const bool unused =
            (name == "t" && !model.parameters.uses_time) || (name == "temp" && !model.parameters.uses_temperature);
        if (!unused) {
            result.push_back(
                {name, (name == "t" ? "const Scalar& " : "const Scalar* ") + name, meaning.at(name), false, true});
        }
    }
    for (const std::string& name : plan.outputs) {
        result.push_back({name, "Scalar* " + name, meaning.at(name), true, true});
    }
    return result;
}

/// Functions of <cmath> that the live part of a graph calls, in alphabetical order.
std::vector<std::string> called_functions(const expression_graph& graph) {
    std::set<std::string> names;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (live[id] && node.kind == operation::function && node.function != function_kind::sign) {
            names.insert(to_string(node.function));
        }
    }
    return {names.begin(), names.end()};
}

/// Arguments that the live part of a graph reads.
std::set<std::string> arrays_read(const expression_graph& graph) {
    std::set<std::string> names;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        if (live[id] && graph.nodes()[id].kind == operation::symbol) {
            names.insert(argument_name(graph.nodes()[id].role));
        }
    }
    return names;
}

/// Names that mean something else in the body: arguments, the scalar type and the functions it uses.
std::set<std::string> reserved_names() {
    std::set<std::string> names = {"Scalar", "std", "q", "qd", "qdd", "tau", "t",       "temp",
                                   "chi",    "W",   "M", "N",  "G",   "D",   "standard"};
    for (int kind = static_cast<int>(function_kind::sin); kind <= static_cast<int>(function_kind::pow); ++kind) {
        names.insert(to_string(static_cast<function_kind>(kind)));
    }
    return names;
}

function_context lay_out(const function_plan& plan, const robot_model& model, const expression_graph& graph) {
    function_context function{plan.name,
                              plan.summary,
                              arguments(plan, model),
                              count_operations(graph),
                              called_functions(graph),
                              print_cpp(graph, reserved_names())};
    const std::set<std::string> read = arrays_read(graph);
    for (argument_context& argument : function.arguments) {
        argument.used = argument.is_output || read.count(argument.name) != 0;
    }
    return function;
}

function_context derive(const function_plan& plan, const robot_model& model) {
    return lay_out(plan, model,
                   build_graph(plan.build(model.tree, model.parameters, model.base.selection()), constants_as::values));
}

/// chi = standard parameters regrouped: what a-priori values of links become.
function_context derive_regrouping(const robot_model& model) {
    expression_graph graph;
    for (std::size_t k = 0; k < model.base.parameters.size(); ++k) {
        const base_parameter& base = model.base.parameters[k];
        const auto standard = [&](std::size_t p) {
            return graph.symbol({model.parameters.all[p].name, symbol_role::standard, static_cast<int>(p)});
        };
        signed_node sum = standard(base.standard);
        for (const regrouped_term& term : base.regrouped) {
            const signed_node other = standard(term.standard);
            const signed_node scaled = graph.multiply(graph.constant(term.exact), other);
            sum = graph.add(sum, scaled);
        }
        graph.output("chi", static_cast<int>(k), sum);
    }
    function_plan plan{
        "regroup", "Base parameters of a robot whose standard parameters are known.", {"standard"}, {"chi"}, {}};
    return lay_out(plan, model, graph);
}

std::vector<joint_context> joints(const robot_model& model) {
    std::vector<joint_context> result;
    for (const int j : model.tree.driven) {
        const joint_description& joint = model.description.joints[static_cast<std::size_t>(j)];
        const bool prismatic = joint.type == joint_type::prismatic;
        result.push_back({joint.name, prismatic, joint.drive_gain.value_or(0.0), joint.limits.velocity.value_or(0.0),
                          prismatic ? "m" : "rad"});
    }
    return result;
}

std::vector<std::string> effect_list(const robot_description& robot) {
    std::vector<std::string> result;
    for (const effect_use& use : robot.effects) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < use.joints.size(); ++i) {
            const std::string& joint = robot.joints[static_cast<std::size_t>(use.joints[i])].name;
            names.push_back(
                use.from.empty() ? joint : joint + " from " + robot.joints[static_cast<std::size_t>(use.from[i])].name);
        }
        std::string text = fmt::format("{} at {}", use.effect, fmt::join(names, ", "));
        for (const auto& [name, value] : use.shape) {
            text += fmt::format(", {} = {}", name, value);
        }
        result.push_back(text);
    }
    return result;
}

std::vector<std::string> constant_list(const kinematic_tree& tree) {
    std::vector<std::string> result;
    for (const kinematic_constant& constant : tree.constants) {
        if (constant.is_named && constant.angle < 0) {
            result.push_back(fmt::format("{} = {}", constant.text, constant.value.to_double()));
        }
    }
    return result;
}

}  // namespace

template_context build_context(const robot_model& model, const std::string& version, const std::string& input_hash,
                               model_operations& operations) {
    template_context context;
    context.robot = model.description.name;
    context.version = version;
    context.robot_file = std::filesystem::path(model.description.file).filename().string();
    context.input_hash = input_hash;
    context.constants = constant_list(model.tree);
    context.effects = effect_list(model.description);
    context.joints = joints(model);
    for (const base_parameter& base : model.base.parameters) {
        context.base_parameters.push_back({base.name, base.unit, base.formula});
    }
    for (const standard_parameter& parameter : model.parameters.all) {
        context.standard_parameters.push_back({parameter.name, parameter.unit, parameter.name});
    }
    context.uses_time = model.parameters.uses_time;
    context.uses_temperature = model.parameters.uses_temperature;
    for (const function_plan& plan : plans()) {
        context.functions.push_back(derive(plan, model));
    }
    context.functions.push_back(derive_regrouping(model));
    operations = {context.functions[1].operations, context.functions[0].operations, context.functions[2].operations,
                  context.functions[5].operations};
    return context;
}

model_operations count_rigid(const robot_model& model) {
    const auto count = [&model](const model_builder& build) {
        return count_operations(
            build_graph(build(model.tree, model.parameters, model.base.rigid), constants_as::values));
    };
    return {count(inverse_dynamics_model), count(regressor_model), count(mass_matrix_model),
            count(forward_dynamics_model)};
}

}  // namespace idim::generator
