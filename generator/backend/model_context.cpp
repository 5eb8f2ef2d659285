#include "backend/model_context.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "backend/form_choice.hpp"
#include "backend/function_spelling.hpp"
#include "backend/rigid_operations.hpp"
#include "dynamics/dynamic_models.hpp"
#include "graph/derivatives.hpp"
#include "graph/sum_rewriting.hpp"

namespace idim::generator {

namespace {

using model_builder = std::function<symbolic_model(const kinematic_tree&, const standard_parameters&,
                                                   const parameter_selection&, const model_form&)>;

/// A generated function before it is derived.
struct function_plan {
    std::string name;
    std::string summary;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
    model_builder build;
    form_space forms;
};

using merging = model_form::merging;

/// Of models that take a torque from a motion, without and with M, and of the regressor.
const form_space torque_forms = {{merging::tips, true, true, false}, true, false, true, true};
const form_space inertia_forms = {{merging::all, true, true, true}, true, true, true, false};
const form_space gravity_forms = {{merging::all, false, true, false}, false, false, false, false};
const form_space regressor_forms = {{merging::none, false, false, true}, false, true, false, false};

std::vector<function_plan> plans() {
    return {
        {"regressor",
         "Regressor of the base parameters: tau = W(q, qd, qdd) chi.",
         {"q", "qd", "qdd", "t", "temp", "state", "tau_rigid", "motor"},
         {"W"},
         regressor_model,
         regressor_forms},
        {"inverse_dynamics",
         "Inverse dynamic model: tau = M(q) qdd + N(q, qd).",
         {"q", "qd", "qdd", "t", "temp", "state", "motor", "chi"},
         {"tau"},
         inverse_dynamics_model,
         torque_forms},
        {"mass_matrix",
         "Inertia matrix of the robot with its drives.",
         {"q", "load_t", "chi"},
         {"M"},
         mass_matrix_model,
         inertia_forms},
        {"bias",
         "Torque at zero acceleration: centrifugal, Coriolis, gravity, friction and other effects.",
         {"q", "qd", "t", "temp", "state", "chi"},
         {"N"},
         bias_model,
         torque_forms},
        {"gravity",
         "Torque that holds the rigid links at rest.",
         {"q", "load_t", "chi"},
         {"G"},
         gravity_model,
         gravity_forms},
        {"forward_dynamics",
         "Direct dynamic model: qdd = M(q)^-1 (tau - N(q, qd)), by M = L' D L.",
         {"q", "qd", "tau", "t", "temp", "state", "tau_rigid", "chi"},
         {"qdd", "D"},
         forward_dynamics_model,
         inertia_forms},
    };
}

/// Functions of robots with loops, and of those whose effects need more than the motion.
std::vector<function_plan> further_plans(const robot_model& model) {
    const standard_parameters& parameters = model.parameters;
    std::vector<function_plan> result;
    if (!model.tree.closures.empty()) {
        result.push_back({"closure",
                          "How well the loops close. The other models have no value (NaN) where one does not.",
                          {"q"},
                          {"closed"},
                          closure_model,
                          {}});
    }
    if (parameters.uses_rigid_torque || parameters.has_elastic_joint()) {
        result.push_back({"rigid_torque",
                          "Torque of the links and payloads alone.",
                          {"q", "qd", "qdd", "load_t", "chi"},
                          {"tau_rigid"},
                          rigid_torque_model,
                          torque_forms});
    }
    if (!parameters.states.empty()) {
        result.push_back({"first_states",
                          "States of effects at the first sample of a motion.",
                          {"q", "qd", "qdd", "t", "temp", "motor"},
                          {"start"},
                          first_states_model,
                          {}});
        result.push_back({"next_states",
                          "States of effects at the sample after this one.",
                          {"q", "qd", "qdd", "t", "temp", "state", "motor", "dt"},
                          {"next"},
                          next_states_model,
                          {}});
    }
    return result;
}

/// Every argument of every function, by its name.
std::map<std::string, function_argument> all_arguments(int n, int b, int s, int states, int loops) {
    std::map<std::string, function_argument> result;
    const auto add = [&result](const std::string& name, int size, const std::string& meaning) {
        result[name] = {name, size, name + " " + meaning};
    };
    add("q", n, fmt::format("[{}] joint positions [rad or m]", n));
    add("qd", n, fmt::format("[{}] joint velocities [rad/s or m/s]", n));
    add("qdd", n, fmt::format("[{}] joint accelerations [rad/s^2 or m/s^2]", n));
    add("tau", n, fmt::format("[{}] joint torques or forces, joint side [N*m or N]", n));
    add("t", 0, "time [s]");
    add("temp", n, fmt::format("[{}] joint temperatures [degC]", n));
    result["load_t"] = {"t", 0, "t time, for what is carried then [s]"};
    add("state", states, fmt::format("[{}] states of effects, in the order of state_names", states));
    add("start", states, fmt::format("[{}] states of effects at the first sample", states));
    add("next", states, fmt::format("[{}] states of effects dt later", states));
    add("dt", 0, "time between samples [s]");
    add("tau_rigid", n, fmt::format("[{}] torque of links and payloads alone, as rigid_torque gives it", n));
    add("motor", 3 * n, fmt::format("[3 x {}] positions, velocities, accelerations of the motors, joint side", n));
    add("chi", b, "[base_parameters] base parameters, in the order of base_parameter_names");
    add("W", n * b, fmt::format("[{} x base_parameters] row-major, row = joint, column = base parameter", n));
    add("M", n * n, fmt::format("[{} x {}] symmetric", n, n));
    add("N", n, fmt::format("[{}] joint torques or forces [N*m or N]", n));
    add("G", n, fmt::format("[{}] joint torques or forces [N*m or N]", n));
    add("closed", loops,
        fmt::format("[{}] of each loop the squared sine of the angle at its cut: it closes where this is positive",
                    loops));
    add("D", n, fmt::format("[{}] pivots, all positive if and only if M is positive definite", n));
    add("dtau_dq", n * n, fmt::format("[{} x {}] row-major, row = torque, column = position", n, n));
    add("dtau_dqd", n * n, fmt::format("[{} x {}] row-major, row = torque, column = velocity", n, n));
    add("standard", s, "[standard_parameters] standard parameters, in the order of standard_parameter_names");
    return result;
}

std::vector<function_argument> arguments(const function_plan& plan, const robot_model& model) {
    const auto known = all_arguments(
        model.tree.dof(), static_cast<int>(model.base.parameters.size()), static_cast<int>(model.parameters.all.size()),
        static_cast<int>(model.parameters.states.size()), static_cast<int>(model.tree.closures.size()));
    const standard_parameters& effects = model.parameters;
    const std::map<std::string, bool> is_used = {{"t", effects.uses_time},
                                                 {"load_t", !effects.gates.empty()},
                                                 {"temp", effects.uses_temperature},
                                                 {"state", !effects.states.empty()},
                                                 {"tau_rigid", effects.uses_rigid_torque},
                                                 {"motor", effects.has_elastic_joint()}};
    std::vector<function_argument> result;
    for (const std::string& name : plan.inputs) {
        const auto known_use = is_used.find(name);
        if (known_use == is_used.end() || known_use->second) {
            result.push_back(known.at(name));
        }
    }
    for (const std::string& name : plan.outputs) {
        result.push_back(known.at(name));
        result.back().is_output = true;
    }
    return result;
}

// 2026-11-22: should code name its constants (constexpr L = 0.5), so that a changed length is a change of one line?
// That takes constants as symbols, and lengths that are equal, sums and products of lengths are then no longer shared
// and folded: 1 to 6 multiplications more in M and in the direct model (Denso 125 -> 130, PUMA 137 -> 143), none
// elsewhere. Kept as values: a changed length touches few lines, and each of them holds it.
expression_graph cheapest(const function_plan& plan, const robot_model& model, const parameter_selection& selection,
                          cost_target target) {
    return in_cheapest_form(model.tree, plan.forms, target, [&](const model_form& form) {
        return with_rewritten_sums(
            build_graph(plan.build(model.tree, model.parameters, selection, form), constants_as::values));
    });
}

model_function derive(const function_plan& plan, const robot_model& model, cost_target target) {
    return {plan.name, plan.summary, arguments(plan, model), cheapest(plan, model, model.base.selection(), target)};
}

/// How the torque changes with position and velocity. By accelerations and parameters it is linear: M and W.
model_function derive_derivatives(const robot_model& model, cost_target target) {
    const function_plan plan{
        "inverse_dynamics_derivatives",
        "Derivatives of inverse_dynamics by q and qd, of sign(x) zero; by qdd they are mass_matrix, by "
        "chi regressor.",
        {"q", "qd", "qdd", "t", "temp", "state", "motor", "chi"},
        {"dtau_dq", "dtau_dqd"},
        inverse_dynamics_model,
        torque_forms};
    model_function torque = derive(plan, model, target);
    const int n = model.tree.dof();
    torque.graph =
        differentiate(torque.graph, {{"dtau_dq", symbol_role::position, n}, {"dtau_dqd", symbol_role::velocity, n}});
    return torque;
}

/// chi = standard parameters regrouped: what a-priori values of links become.
model_function derive_regrouping(const robot_model& model) {
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
        graph.name(sum, base.name + (sum.negative ? "n" : ""));
        graph.output("chi", static_cast<int>(k), sum);
    }
    const function_plan plan{
        "regroup", "Base parameters of a robot whose standard parameters are known.", {"standard"}, {"chi"}, {}, {}};
    return {plan.name, plan.summary, arguments(plan, model), std::move(graph)};
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

std::vector<std::string> constant_list(const robot_model& model) {
    std::vector<std::string> result;
    for (const auto& [name, value] : named_constants(model)) {
        result.push_back(fmt::format("{} = {}", name, value));
    }
    return result;
}

/// What the identifiers have to know of effects beside the functions.
void set_effects(const robot_model& model, template_context& context) {
    const standard_parameters& parameters = model.parameters;
    context.uses_rigid_torque = parameters.uses_rigid_torque;
    context.has_elastic_joint = parameters.has_elastic_joint();
    context.has_payload = !parameters.gates.empty();
    for (const effect_memory& state : parameters.states) {
        context.states.push_back(state.name);
    }
    for (std::size_t j = 0; j < context.joints.size(); ++j) {
        context.joints[j].torque_delay = parameters.drives[j].delay;
        context.joints[j].stiffness = parameters.drives[j].stiffness;
        context.joints[j].damping = parameters.drives[j].damping;
    }
    for (std::size_t k = 0; k < context.base_parameters.size(); ++k) {
        context.base_parameters[k].per_log = parameters.all[model.base.parameters[k].standard].per_log;
    }
}

/// Counts for the links alone.
model_operations count_rigid(const robot_model& model, const std::vector<model_function>& functions,
                             cost_target target) {
    const std::vector<std::size_t> kept = model.base.selection().kept;
    const std::vector<std::size_t>& rigid = model.base.rigid.kept;
    std::vector<bool> is_of_link;
    for (const std::size_t p : kept) {
        is_of_link.push_back(std::binary_search(rigid.begin(), rigid.end(), p));
    }
    const std::vector<function_plan> all = plans();
    const auto count = [&](std::size_t i) {
        // Where an effect takes the place of a link's parameter, its model is not one of the links alone.
        return std::includes(kept.begin(), kept.end(), rigid.begin(), rigid.end())
                   ? rigid_operations(functions[i].graph, is_of_link)
                   : count_operations(cheapest(all[i], model, model.base.rigid, target));
    };
    return {count(1), count(0), count(2), count(5)};
}

element_names names_of(const template_context& context) {
    element_names names{context.robot, {}, {}};
    for (const parameter_context& parameter : context.base_parameters) {
        names.base.push_back(parameter.name);
    }
    for (const parameter_context& parameter : context.standard_parameters) {
        names.standard.push_back(parameter.name);
    }
    return names;
}

}  // namespace

std::vector<std::pair<std::string, double>> named_constants(const robot_model& model) {
    std::map<std::string, double> values;  // a constant that is zero is no symbol of the tree
    for (const kinematic_constant& constant : model.tree.constants) {
        if (constant.is_named && constant.angle < 0) {
            values[constant.text] = constant.value.to_double();
        }
    }
    std::vector<std::pair<std::string, double>> result;
    for (const constant_description& constant : model.description.constants) {
        result.emplace_back(constant.name, values[constant.name]);
    }
    return result;
}

template_context build_context(const robot_model& model, const file_origin& origin, bool derivatives,
                               const languages& spellings, operation_counts& operations) {
    template_context context;
    context.robot = model.description.name;
    context.version = origin.version;
    context.robot_file = std::filesystem::path(model.description.file).filename().string();
    context.input_hash = origin.input_hash;
    context.cost = to_string(origin.cost);
    context.constants = constant_list(model);
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
    context.closures = static_cast<int>(model.tree.closures.size());
    set_effects(model, context);
    std::vector<model_function> functions;
    for (const function_plan& plan : plans()) {
        functions.push_back(derive(plan, model, origin.cost));
    }
    functions.push_back(derive_regrouping(model));
    for (const function_plan& plan : further_plans(model)) {
        functions.push_back(derive(plan, model, origin.cost));
    }
    if (derivatives) {
        functions.push_back(derive_derivatives(model, origin.cost));
    }
    spelled_models spelled = spell(functions, names_of(context), spellings);
    context.functions = std::move(spelled.functions);
    context.sines = spelled.sines;
    operations.declared = {context.functions[1].operations, context.functions[0].operations,
                           context.functions[2].operations, context.functions[5].operations};
    operations.rigid = count_rigid(model, functions, origin.cost);
    return context;
}

}  // namespace idim::generator
