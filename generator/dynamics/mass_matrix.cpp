#include "dynamics/mass_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// A link with everything outward of it, frozen, at the origin of the link's frame.
struct composite_body {
    symmetric3 J;
    vector3 S = {0, 0, 0};
    ex mass = 0;
};

symmetric3 sum(symbolic_model& model, const std::string& name, const symmetric3& a, const symmetric3& b) {
    return {model.assign(name + "_xx", a.xx + b.xx), model.assign(name + "_xy", a.xy + b.xy),
            model.assign(name + "_xz", a.xz + b.xz), model.assign(name + "_yy", a.yy + b.yy),
            model.assign(name + "_yz", a.yz + b.yz), model.assign(name + "_zz", a.zz + b.zz)};
}

/// What moving the reference point by P adds to the inertia of a body of mass M and first moments S (about the old
/// point, in the new axes): 2 (P.S) 1 - P S' - S P' + M (P.P 1 - P P').
symmetric3 transport(symbolic_model& model, const std::string& name, const vector3& P, const vector3& S, const ex& M) {
    // With T = S + M P / 2 this is 2 (P.T) 1 - P T' - T P'.
    const vector3 T = model.assign(name + "T", vector3{S[0] + M * P[0] / 2, S[1] + M * P[1] / 2, S[2] + M * P[2] / 2});
    const ex x = model.assign(name + "_2x", 2 * P[0] * T[0]);
    const ex y = model.assign(name + "_2y", 2 * P[1] * T[1]);
    const ex z = model.assign(name + "_2z", 2 * P[2] * T[2]);
    return {y + z, -P[0] * T[1] - P[1] * T[0], -P[0] * T[2] - P[2] * T[0], x + z, -P[1] * T[2] - P[2] * T[1], x + y};
}

std::vector<composite_body> composites(symbolic_model& model, const kinematic_tree& tree,
                                       const std::vector<link_frame>& frames, const parameter_values& values) {
    std::vector<composite_body> bodies;
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        const int link = static_cast<int>(j);
        bodies.push_back({values.inertia(link), values.first_moments(link), values.inertial(link, parameter_kind::M)});
    }
    for (std::size_t j = tree.joints.size(); j-- > 0;) {
        const kinematic_joint& joint = tree.joints[j];
        if (joint.antecedent < 0) {
            continue;
        }
        composite_body& before = bodies[static_cast<std::size_t>(joint.antecedent)];
        const std::string name = "J" + joint.label;
        const symmetric3 turned = frames[j].to_antecedent(name, bodies[j].J);
        const vector3 S = frames[j].to_antecedent("S" + joint.label, bodies[j].S);
        const symmetric3 moved = transport(model, name + "t", frames[j].position(), S, bodies[j].mass);
        before.J = sum(model, name + "s", sum(model, name + "r", turned, moved), before.J);
        const vector3& P = frames[j].position();
        const ex& mass = bodies[j].mass;
        before.S =
            model.assign("SS" + joint.label, vector3{before.S[0] + S[0] + mass * P[0], before.S[1] + S[1] + mass * P[1],
                                                     before.S[2] + S[2] + mass * P[2]});
        before.mass = model.assign("MM" + joint.label, before.mass + mass);
    }
    return bodies;
}

/// Adds the inertia h between two joints to the coordinates that move them: M = G' H G with the joint rates G.
void add_coupled(const kinematic_joint& outer, const kinematic_joint& inner, const ex& h, bool same,
                 std::vector<std::vector<ex>>& M) {
    for (const joint_rate& i : outer.rates) {
        for (const joint_rate& j : inner.rates) {
            const auto row = static_cast<std::size_t>(std::max(i.coordinate, j.coordinate));
            const auto column = static_cast<std::size_t>(std::min(i.coordinate, j.coordinate));
            if (same && j.coordinate > i.coordinate) {
                continue;  // the pair (j, i) stands for both halves of a diagonal block
            }
            const bool twice = !same && i.coordinate == j.coordinate;  // h and its transpose meet on the diagonal
            M[row][column] += (twice ? 2 : 1) * i.factor * j.factor * h;
        }
    }
}

/// Adds to the lower triangle of M what acceleration of one joint takes at that joint and all inward of it.
void add_joint_inertia(symbolic_model& model, const kinematic_tree& tree, const std::vector<link_frame>& frames,
                       const std::vector<composite_body>& bodies, int accelerated, std::vector<std::vector<ex>>& M) {
    const kinematic_joint& joint = tree.joints[static_cast<std::size_t>(accelerated)];
    const composite_body& body = bodies[static_cast<std::size_t>(accelerated)];
    const bool turns = joint.type == joint_type::revolute;
    // Wrench that a unit acceleration of the joint takes, carried inward.
    vector3 f = turns ? vector3{-body.S[1], body.S[0], 0} : vector3{0, 0, body.mass};
    vector3 m = turns ? vector3{body.J.xz, body.J.yz, body.J.zz} : vector3{body.S[1], -body.S[0], 0};
    for (int link = accelerated;;) {
        const kinematic_joint& at = tree.joints[static_cast<std::size_t>(link)];
        add_coupled(joint, at, at.type == joint_type::revolute ? m[2] : f[2], link == accelerated, M);
        if (at.antecedent < 0) {
            return;
        }
        const link_frame& frame = frames[static_cast<std::size_t>(link)];
        const std::string suffix = fmt::format("{}_{}", joint.label, at.label);
        const vector3 force = frame.to_antecedent("mf" + suffix, f);
        const vector3 moment = frame.to_antecedent("mn" + suffix, m);
        m = model.assign("mm" + suffix, add(moment, cross(frame.position(), force)));
        f = force;
        link = at.antecedent;
    }
}

/// Contribution of the effects to d tau_i / d qdd_j.
ex effect_inertia(const kinematic_tree& tree, const standard_parameters& parameters, const parameter_values& values,
                  int i, int j) {
    const ex torque = parameters.without_elasticity(tree, effect_torque(parameters, values, i));
    return torque.diff(tree.qdd[static_cast<std::size_t>(j)]);
}

}  // namespace

std::vector<std::vector<ex>> inertia_elements(symbolic_model& model, const kinematic_tree& tree,
                                              const std::vector<link_frame>& frames,
                                              const standard_parameters& parameters, const parameter_values& values) {
    const std::vector<composite_body> bodies = composites(model, tree, frames, values);
    const auto n = static_cast<std::size_t>(tree.dof());
    std::vector<std::vector<ex>> M(n, std::vector<ex>(n, 0));
    for (std::size_t i = 0; i < tree.joints.size(); ++i) {
        if (!tree.joints[i].rates.empty()) {
            add_joint_inertia(model, tree, frames, bodies, static_cast<int>(i), M);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const ex effects = effect_inertia(tree, parameters, values, static_cast<int>(i), static_cast<int>(j));
            M[i][j] = model.assign(fmt::format("M{}_{}", i + 1, j + 1), M[i][j] + effects);
        }
    }
    return M;
}

symbolic_model mass_matrix_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& selection) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    const std::vector<link_frame> frames = declare_motion(model, tree, {false, false, false});
    const auto M = inertia_elements(model, tree, frames, parameters, values);
    const std::size_t n = M.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            const ex element = M[std::max(i, j)][std::min(i, j)];
            const ex& gain = parameters.drives[i].gain;
            const std::string name = fmt::format("M{}_{}_recorded", i + 1, j + 1);
            model.output("M", static_cast<int>(i * n + j),
                         gain.is_equal(1) ? element : model.assign(name, gain * element));
        }
    }
    return model;
}

}  // namespace idim::generator
