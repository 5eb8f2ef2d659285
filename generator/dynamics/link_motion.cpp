#include "dynamics/link_motion.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Fills the products of angular velocities and U, once per link.
void complete(symbolic_model& model, link_motion& link, const std::string& label) {
    const auto product = [&](const std::string& name, std::size_t a, std::size_t b) {
        return model.assign(name + label, link.W[a] * link.W[b]);
    };
    const ex xx = link.WxWx = product("WxWx", 0, 0);
    const ex yy = link.WyWy = product("WyWy", 1, 1);
    const ex zz = link.WzWz = product("WzWz", 2, 2);
    link.WxWy = product("WxWy", 0, 1);
    link.WxWz = product("WxWz", 0, 2);
    link.WyWz = product("WyWz", 1, 2);
    const auto element = [&](const std::string& name, const ex& value) { return model.assign(name + label, value); };
    link.U[0] = {element("U11_", -yy - zz), element("U12_", link.WxWy - link.WP[2]),
                 element("U13_", link.WxWz + link.WP[1])};
    link.U[1] = {element("U21_", link.WxWy + link.WP[2]), element("U22_", -xx - zz),
                 element("U23_", link.WyWz - link.WP[0])};
    link.U[2] = {element("U31_", link.WxWz - link.WP[1]), element("U32_", link.WyWz + link.WP[0]),
                 element("U33_", -xx - yy)};
}

vector3 times(const std::array<vector3, 3>& m, const vector3& v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

link_motion base_motion(const kinematic_tree& tree, const motion_inputs& inputs) {
    link_motion base;
    base.W = base.WP = base.VP = {0, 0, 0};
    base.U = {base.W, base.W, base.W};
    if (inputs.gravity) {
        base.VP = {-tree.gravity[0], -tree.gravity[1], -tree.gravity[2]};
    }
    return base;
}

/// Velocity or acceleration of a joint from those of its coordinates.
ex of_joint(symbolic_model& model, const kinematic_joint& joint, const std::vector<GiNaC::symbol>& of_coordinates,
            const std::string& name) {
    ex sum = 0;
    for (const joint_rate& rate : joint.rates) {
        sum += rate.factor * of_coordinates[static_cast<std::size_t>(rate.coordinate)];
    }
    return joint.rates.size() > 1 ? model.assign(name + joint.label, sum) : sum;
}

/// One joint: Luh, Walker and Paul 1980 in the link's own frame (Khalil and Dombre 2002, eqs. 9.86-9.90).
link_motion step(symbolic_model& model, const kinematic_tree& tree, std::size_t j, const link_frame& frame,
                 const link_motion& before, const motion_inputs& inputs) {
    const kinematic_joint& joint = tree.joints[j];
    const std::string& label = joint.label;
    const ex rate = inputs.velocity ? of_joint(model, joint, tree.qd, "dq") : ex(0);
    const ex acceleration = inputs.acceleration ? of_joint(model, joint, tree.qdd, "ddq") : ex(0);
    const vector3 W = frame.to_link("W" + label, before.W);
    const vector3 WP = frame.to_link("WP" + label, before.WP);
    const vector3 carried = model.assign("VC" + label, add(before.VP, times(before.U, frame.position())));
    const vector3 VP = frame.to_link("VP" + label, carried);
    link_motion link;
    link.W = W;
    link.WP = WP;
    link.VP = VP;
    if (joint.type == joint_type::revolute) {
        link.W[2] = model.assign("W" + label + "_3", W[2] + rate);
        link.WP =
            model.assign("WP" + label + "r", vector3{WP[0] + W[1] * rate, WP[1] - W[0] * rate, WP[2] + acceleration});
    } else if (joint.type == joint_type::prismatic) {
        const ex twice = model.assign("twice_rate" + label, 2 * rate);
        link.VP =
            model.assign("VP" + label + "r", vector3{VP[0] + twice * W[1], VP[1] - twice * W[0], VP[2] + acceleration});
    }
    complete(model, link, label);
    return link;
}

}  // namespace

std::vector<link_frame> declare_motion(symbolic_model& model, const kinematic_tree& tree, const motion_inputs& inputs) {
    const auto declare = [&model](const std::vector<GiNaC::symbol>& symbols, symbol_role role) {
        for (std::size_t i = 0; i < symbols.size(); ++i) {
            model.declare(symbols[i], {symbols[i].get_name(), role, static_cast<int>(i)});
        }
    };
    declare(tree.q, symbol_role::position);
    if (inputs.velocity) {
        declare(tree.qd, symbol_role::velocity);
    }
    if (inputs.acceleration) {
        declare(tree.qdd, symbol_role::acceleration);
    }
    std::vector<link_frame> frames;
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        frames.emplace_back(model, tree.joints[j]);
    }
    return frames;
}

std::vector<link_motion> propagate_motion(symbolic_model& model, const kinematic_tree& tree,
                                          const std::vector<link_frame>& frames, const motion_inputs& inputs) {
    const link_motion base = base_motion(tree, inputs);
    std::vector<link_motion> links;
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        const int antecedent = tree.joints[j].antecedent;
        const link_motion& before = antecedent < 0 ? base : links[static_cast<std::size_t>(antecedent)];
        links.push_back(step(model, tree, j, frames[j], before, inputs));
    }
    return links;
}

}  // namespace idim::generator
