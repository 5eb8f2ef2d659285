#include "dynamics/virtual_power.hpp"

#include <fmt/format.h>

#include "dynamics/link_motion.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Virtual velocities of a link in its own frame.
struct virtual_twist {
    vector3 angular = {0, 0, 0};
    vector3 linear = {0, 0, 0};  ///< of the origin of the link's frame
};

virtual_twist step(symbolic_model& model, const kinematic_joint& joint, const link_frame& frame,
                   const virtual_twist& before, const std::vector<GiNaC::symbol>& v) {
    const vector3 carried =
        model.assign("vc" + joint.label, add(before.linear, cross(before.angular, frame.position())));
    virtual_twist link{frame.to_link("w" + joint.label, before.angular), frame.to_link("v" + joint.label, carried)};
    ex& along = joint.type == joint_type::revolute ? link.angular[2] : link.linear[2];
    for (const joint_rate& rate : joint.rates) {
        along += rate.factor * v[static_cast<std::size_t>(rate.coordinate)];
    }
    along = model.assign("along" + joint.label, along);
    return link;
}

/// Power per unit of each inertial parameter of a link, in the order of parameter_kind: the twist (w, v) on the force
/// f = M VP + WP x MS + W x (W x MS) and the moment n = J WP + W x (J W) + MS x VP at the link's origin.
std::array<ex, 10> inertial_columns(symbolic_model& model, const link_motion& link, const virtual_twist& twist,
                                    const std::string& label) {
    const vector3& w = twist.angular;
    const vector3& v = twist.linear;
    const vector3 s = model.assign("s" + label, cross(w, link.W));  // w . (W x J W) = s . J W
    const auto inertia = [&](std::size_t a, std::size_t b) { return w[a] * link.WP[b] + s[a] * link.W[b]; };
    const ex along = model.assign("vW" + label, dot(v, link.W));
    const ex square = model.assign("WW" + label, dot(link.W, link.W));
    const vector3 from_force = cross(v, link.WP);
    const vector3 from_moment = cross(link.VP, w);
    const auto first_moment = [&](std::size_t i) {
        return from_force[i] + along * link.W[i] - square * v[i] + from_moment[i];
    };
    return {inertia(0, 0),
            inertia(0, 1) + inertia(1, 0),
            inertia(0, 2) + inertia(2, 0),
            inertia(1, 1),
            inertia(1, 2) + inertia(2, 1),
            inertia(2, 2),
            first_moment(0),
            first_moment(1),
            first_moment(2),
            dot(v, link.VP)};
}

/// Beside the motion everything that effects read is free: states, motions of motors, the torque of the links, and
/// whether a payload is on.
void declare_as_free(symbolic_model& model, const standard_parameters& parameters) {
    if (!parameters.gates.empty()) {
        model.declare(parameters.time, {"t", symbol_role::time, 0});
    }
    for (std::size_t g = 0; g < parameters.gates.size(); ++g) {
        const GiNaC::symbol& symbol = parameters.gates[g].symbol;
        model.declare(symbol, {symbol.get_name(), symbol_role::time, static_cast<int>(g) + 1});
    }
    declare_signals(model, parameters);
    declare_rigid_torque(model, parameters);
}

}  // namespace

symbolic_model virtual_power_model(const kinematic_tree& tree, const standard_parameters& parameters) {
    symbolic_model model(tree);
    declare_as_free(model, parameters);
    declare_motion(model, tree, {});
    const link_axes axes = lay_axes(model, tree, {});
    std::vector<GiNaC::symbol> v;
    for (int i = 0; i < tree.dof(); ++i) {
        v.push_back(model.declare({fmt::format("v{}", i + 1), symbol_role::velocity, tree.dof() + i}));
    }
    const motion_recursion motion(model, tree, axes, {});
    std::vector<virtual_twist> twists;
    std::vector<std::array<ex, 10>> inertial;
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        const kinematic_joint& joint = tree.joints[j];
        const virtual_twist before =
            joint.antecedent < 0 ? virtual_twist{} : twists[static_cast<std::size_t>(joint.antecedent)];
        twists.push_back(step(model, joint, axes.frames[j], before, v));
        inertial.push_back(inertial_columns(model, motion.of_link(j), twists.back(), joint.label));
    }
    for (std::size_t p = 0; p < parameters.all.size(); ++p) {
        const standard_parameter& parameter = parameters.all[p];
        ex power = 0;
        if (parameter.kind != parameter_kind::effect) {
            power = inertial[static_cast<std::size_t>(parameter.joint)][static_cast<std::size_t>(parameter.kind)];
            power *= parameter.gate >= 0 ? gate_of(parameters, parameter) : ex(1);
        }
        for (const auto& [coordinate, column] : parameter.columns) {
            power += v[static_cast<std::size_t>(coordinate)] * column;
        }
        model.output("w", static_cast<int>(p), model.assign("power_" + parameter.name, power));
    }
    return model;
}

}  // namespace idim::generator
