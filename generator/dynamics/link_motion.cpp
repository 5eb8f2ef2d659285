#include "dynamics/link_motion.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

void fill_products(symbolic_model& model, link_motion& link, const std::string& label) {
    const auto product = [&](const std::string& name, std::size_t a, std::size_t b) {
        return model.assign(name + label, link.W[a] * link.W[b]);
    };
    link.squares = {product("WxWx", 0, 0), product("WyWy", 1, 1), product("WzWz", 2, 2)};
    link.WxWy = product("WxWy", 0, 1);
    link.WxWz = product("WxWz", 0, 2);
    link.WyWz = product("WyWz", 1, 2);
}

void fill_matrix(symbolic_model& model, link_motion& link, const ex& U13, const ex& U23, const std::string& label) {
    const ex& xx = link.squares[0];
    const ex& yy = link.squares[1];
    const ex& zz = link.squares[2];
    const auto element = [&](const std::string& name, const ex& value) { return model.assign(name + label, value); };
    link.U[0] = {element("U11_", -yy - zz), element("U12_", link.WxWy - link.WP[2]), U13};
    link.U[1] = {element("U21_", link.WxWy + link.WP[2]), element("U22_", -xx - zz), U23};
    link.U[2] = {element("U31_", link.WxWz - link.WP[1]), element("U32_", link.WyWz + link.WP[0]),
                 element("U33_", -xx - yy)};
}

void fill_matrix(symbolic_model& model, link_motion& link, const std::string& label) {
    fill_matrix(model, link, model.assign("U13_" + label, link.WxWz + link.WP[1]),
                model.assign("U23_" + label, link.WyWz - link.WP[0]), label);
}

vector3 column(const matrix3& m, std::size_t i) {
    return {m[0][i], m[1][i], m[2][i]};
}

vector3 times(const matrix3& m, const vector3& v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

link_motion base_motion(const kinematic_tree& tree, const motion_inputs& inputs) {
    link_motion base;
    base.W = base.WP = base.VP = base.squares = {0, 0, 0};
    base.U = {base.W, base.W, base.W};
    if (inputs.gravity) {
        base.VP = {-tree.gravity[0], -tree.gravity[1], -tree.gravity[2]};
    }
    return base;
}

ex sum_of_rates(symbolic_model& model, const kinematic_joint& joint, const std::vector<GiNaC::symbol>& of_coordinates,
                const std::string& name) {
    ex sum = 0;
    for (const joint_rate& rate : joint.rates) {
        sum += rate.factor * of_coordinates[static_cast<std::size_t>(rate.coordinate)];
    }
    return joint.rates.size() > 1 ? model.assign(name + joint.label, sum) : sum;
}

}  // namespace

void declare_motion(symbolic_model& model, const kinematic_tree& tree, const motion_inputs& inputs) {
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
    for (const kinematic_definition& definition : tree.from_positions) {
        model.define(definition.symbol, definition.body);
    }
    for (std::size_t i = 0; i < tree.from_velocities.size() && inputs.velocity; ++i) {
        model.define(tree.from_velocities[i].symbol, tree.from_velocities[i].body);
    }
}

joint_rates rates_of(symbolic_model& model, const kinematic_tree& tree, std::size_t joint,
                     const motion_inputs& inputs) {
    const kinematic_joint& of = tree.joints[joint];
    const ex driven = inputs.acceleration ? sum_of_rates(model, of, tree.qdd, "ddq") : ex(0);
    return {inputs.velocity ? sum_of_rates(model, of, tree.qd, "dq") : ex(0),
            inputs.velocity && of.passive ? model.assign("ddq" + of.label + "_all", driven + of.drift) : driven};
}

motion_recursion::motion_recursion(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes,
                                   const motion_inputs& inputs)
    : model_(model), tree_(tree), axes_(axes), inputs_(inputs), base_(base_motion(tree, inputs)) {
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        links_.push_back(step(j));
    }
}

const link_motion& motion_recursion::before(std::size_t joint) const {
    const int antecedent = tree_.joints[joint].antecedent;
    return antecedent < 0 ? base_ : links_[static_cast<std::size_t>(antecedent)];
}

/// WP and U of a link whose joint turns about z, its W known.
void motion_recursion::accelerate(std::size_t j, const joint_rates& rates, link_motion& link) const {
    const link_frame& frame = axes_.frames[j];
    const std::string& label = tree_.joints[j].label;
    const link_motion& from = before(j);
    if (!frame.exchanges_axes()) {
        const vector3 WP = frame.to_link("WP" + label, from.WP);
        link.WP =
            model_.assign("WP" + label + "r", vector3{WP[0] + link.W[1] * rates.velocity,
                                                      WP[1] - link.W[0] * rates.velocity, WP[2] + rates.acceleration});
        fill_matrix(model_, link, label);
        return;
    }
    // Points on the joint's axis move as before: the third column of U stays but for the axes, and WP is what is left
    // of it without the products of W. That saves the products of W and the joint's velocity.
    const vector3 axis = frame.joint_to_antecedent("", vector3{0, 0, 1});
    const vector3 before_turn = frame.antecedent_to_joint("", times(from.U, axis));
    const vector3 third = frame.joint_to_link("UZ" + label, vector3{before_turn[0], before_turn[1], 0});
    link.WP = model_.assign(
        "WP" + label, vector3{link.WyWz - third[1], third[0] - link.WxWz, dot(axis, from.WP) + rates.acceleration});
    fill_matrix(model_, link, third[0], third[1], label);
}

/// One joint: Luh, Walker and Paul 1980 in the link's own axes (Khalil and Dombre 2002, eqs. 9.86-9.90).
link_motion motion_recursion::step(std::size_t j) const {
    const kinematic_joint& joint = tree_.joints[j];
    const std::string& label = joint.label;
    const link_frame& frame = axes_.frames[j];
    const link_motion& from = before(j);
    const joint_rates rates = rates_of(model_, tree_, j, inputs_);
    link_motion link;
    link.W = frame.to_link("W" + label, from.W);
    const vector3 carried = model_.assign("VC" + label, add(from.VP, times(from.U, frame.position())));
    link.VP = frame.to_link("VP" + label, carried);
    if (joint.type == joint_type::revolute) {
        link.W[2] = model_.assign("W" + label + "_3", link.W[2] + rates.velocity);
        fill_products(model_, link, label);
        accelerate(j, rates, link);
        return link;
    }
    link.WP = frame.to_link("WP" + label, from.WP);
    fill_products(model_, link, label);
    fill_matrix(model_, link, label);
    if (joint.type == joint_type::prismatic) {
        const ex twice = model_.assign("twice_rate" + label, 2 * rates.velocity);
        link.VP = model_.assign(
            "VP" + label + "r",
            vector3{link.VP[0] + twice * link.W[1], link.VP[1] - twice * link.W[0], link.VP[2] + rates.acceleration});
    }
    return link;
}

carrying_motion motion_recursion::under_joint(std::size_t j) const {
    const link_frame& frame = axes_.frames[j];
    const std::string label = tree_.joints[j].label + "_under";
    const link_motion& from = before(j);
    const vector3 VC = model_.assign("VC" + tree_.joints[j].label, add(from.VP, times(from.U, frame.position())));
    carrying_motion result;
    result.W = frame.antecedent_to_joint("W" + tree_.joints[j].label, from.W);
    result.VP = frame.antecedent_to_joint("VP" + tree_.joints[j].label, VC);
    result.WP_z = dot(frame.joint_to_antecedent("", vector3{0, 0, 1}), from.WP);
    if (frame.exchanges_axes()) {
        matrix3 columns;  // of U, each in the joint's axes
        for (std::size_t i = 0; i < 3; ++i) {
            columns[i] = frame.antecedent_to_joint("", column(from.U, i));
        }
        for (std::size_t i = 0; i < 3; ++i) {
            result.U[i] = frame.antecedent_to_joint("", column(columns, i));
        }
        const vector3 exchanged = frame.antecedent_to_joint("", vector3{1, 2, 3});
        std::array<std::size_t, 3> source = {};
        for (std::size_t i = 0; i < 3; ++i) {
            source[i] = static_cast<std::size_t>(GiNaC::ex_to<GiNaC::numeric>(GiNaC::abs(exchanged[i])).to_int()) - 1;
            result.squares[i] = from.squares[source[i]];
        }
        const vector3 products = {from.WyWz, from.WxWz, from.WxWy};  // by the component that is not in them
        const ex sign = GiNaC::csgn(exchanged[0] * exchanged[1]);
        result.WxWy = sign * products[3 - source[0] - source[1]];
        return result;
    }
    link_motion same;
    same.W = result.W;
    same.WP = frame.antecedent_to_joint("WP" + tree_.joints[j].label, from.WP);
    fill_products(model_, same, label);
    fill_matrix(model_, same, label);
    result.U = same.U;
    result.WxWy = same.WxWy;
    result.WP_z = same.WP[2];
    result.squares = same.squares;
    return result;
}

}  // namespace idim::generator
