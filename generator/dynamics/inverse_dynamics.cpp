#include "dynamics/inverse_dynamics.hpp"

#include "dynamics/link_motion.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

struct wrench {
    vector3 force = {0, 0, 0};
    vector3 moment = {0, 0, 0};
};

/// Force and moment that move one link, at its origin: f = M VP + U MS, n = J WP + W x (J W) + MS x VP, the inertia
/// term written on the products that U already has, with differences of diagonal inertias folded into one parameter.
wrench link_wrench(symbolic_model& model, const link_motion& link, const parameter_values& values, int index,
                   const std::string& label) {
    const auto& U = link.U;
    const symmetric3 J = values.inertia(index);
    const vector3 S = values.first_moments(index);
    const ex mass = values.inertial(index, parameter_kind::M);
    const ex zzyy = model.assign("ZZYY" + label, J.zz - J.yy);
    const ex xxzz = model.assign("XXZZ" + label, J.xx - J.zz);
    const ex yyxx = model.assign("YYXX" + label, J.yy - J.xx);
    const ex u2233 = J.yz.is_zero() ? ex(0) : model.assign("U2233_" + label, link.WyWy - link.WzWz);
    const ex u3311 = J.xz.is_zero() ? ex(0) : model.assign("U3311_" + label, link.WzWz - link.WxWx);
    const ex u1122 = J.xy.is_zero() ? ex(0) : model.assign("U1122_" + label, link.WxWx - link.WyWy);
    const vector3 lever = cross(S, link.VP);
    const vector3 moment = {
        J.xx * link.WP[0] + zzyy * link.WyWz - J.xy * U[2][0] + J.xz * U[1][0] + J.yz * u2233 + lever[0],
        J.yy * link.WP[1] + xxzz * link.WxWz + J.xy * U[2][1] + J.xz * u3311 - J.yz * U[0][1] + lever[1],
        J.zz * link.WP[2] + yyxx * link.WxWy + J.xy * u1122 - J.xz * U[1][2] + J.yz * U[0][2] + lever[2],
    };
    const vector3 force = {mass * link.VP[0] + dot(U[0], S), mass * link.VP[1] + dot(U[1], S),
                           mass * link.VP[2] + dot(U[2], S)};
    return {model.assign("F" + label, force), model.assign("N" + label, moment)};
}

}  // namespace

std::vector<ex> joint_torques(symbolic_model& model, const kinematic_tree& tree, const std::vector<link_frame>& frames,
                              const parameter_values& values, const motion_inputs& inputs) {
    const std::vector<link_motion> links = propagate_motion(model, tree, frames, inputs);
    std::vector<wrench> carried(tree.joints.size());
    std::vector<ex> torque(static_cast<std::size_t>(tree.dof()), 0);
    for (std::size_t j = tree.joints.size(); j-- > 0;) {
        const kinematic_joint& joint = tree.joints[j];
        const wrench own = link_wrench(model, links[j], values, static_cast<int>(j), joint.label);
        const vector3 f = model.assign("f" + joint.label, add(own.force, carried[j].force));
        const vector3 n = model.assign("n" + joint.label, add(own.moment, carried[j].moment));
        for (const joint_rate& rate : joint.rates) {
            torque[static_cast<std::size_t>(rate.coordinate)] +=
                rate.factor * (joint.type == joint_type::revolute ? n[2] : f[2]);
        }
        if (joint.antecedent >= 0) {
            wrench& before = carried[static_cast<std::size_t>(joint.antecedent)];
            const vector3 force = frames[j].to_antecedent("fa" + joint.label, f);
            const vector3 moment = frames[j].to_antecedent("na" + joint.label, n);
            before.force = model.assign("fs" + joint.label, add(before.force, force));
            before.moment =
                model.assign("ns" + joint.label, add(add(before.moment, moment), cross(frames[j].position(), force)));
        }
    }
    return torque;
}

namespace {

/// The torque as a drive with an error of its gain records it.
ex scaled(symbolic_model& model, const ex& gain, const std::string& name, const ex& torque) {
    return gain.is_equal(1) ? model.assign(name, torque)
                            : model.assign(name, gain * model.assign(name + "_joint", torque));
}

symbolic_model torque_model(const kinematic_tree& tree, const standard_parameters& parameters,
                            const parameter_selection& selection, const motion_inputs& inputs, const std::string& array,
                            bool with_effects) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    declare_signals(model, parameters);
    const std::vector<link_frame> frames = declare_motion(model, tree, inputs);
    const std::vector<ex> torque = joint_torques(model, tree, frames, values, inputs);
    for (std::size_t i = 0; i < torque.size() && with_effects && parameters.uses_rigid_torque; ++i) {
        model.define(parameters.rigid_torque[i], torque[i]);
    }
    for (int i = 0; i < tree.dof(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const ex effects = with_effects ? effect_torque(parameters, values, i) : ex(0);
        const ex still =
            inputs.acceleration ? effects : without_acceleration(parameters.without_elasticity(tree, effects), tree);
        const std::string name = array + std::to_string(i + 1);
        model.output(array, i, scaled(model, parameters.drives[at].gain, name, torque[at] + still));
    }
    return model;
}

}  // namespace

ex without_acceleration(const ex& torque, const kinematic_tree& tree) {
    GiNaC::exmap zero;
    for (const GiNaC::symbol& qdd : tree.qdd) {
        zero[qdd] = 0;
    }
    return torque.subs(zero);
}

symbolic_model inverse_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection) {
    return torque_model(tree, parameters, selection, {true, true, true}, "tau", true);
}

symbolic_model bias_model(const kinematic_tree& tree, const standard_parameters& parameters,
                          const parameter_selection& selection) {
    return torque_model(tree, parameters, selection, {true, false, true}, "N", true);
}

symbolic_model rigid_torque_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                  const parameter_selection& selection) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    const std::vector<link_frame> frames = declare_motion(model, tree, {});
    const std::vector<ex> torque = joint_torques(model, tree, frames, values, {});
    for (std::size_t i = 0; i < torque.size(); ++i) {
        model.output("tau_rigid", static_cast<int>(i), model.assign("rigid" + std::to_string(i + 1), torque[i]));
    }
    return model;
}

symbolic_model gravity_model(const kinematic_tree& tree, const standard_parameters& parameters,
                             const parameter_selection& selection) {
    return torque_model(tree, parameters, selection, {false, false, true}, "G", false);
}

}  // namespace idim::generator
