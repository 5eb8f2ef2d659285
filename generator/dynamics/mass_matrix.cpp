#include "dynamics/mass_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

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

/// The same for all joints from a link inward, whose axes meet there the wrench that acceleration of the outer one
/// takes.
void add_met(model_frame& frame, const kinematic_joint& outer, std::size_t link, const wrench& w,
             std::vector<std::vector<ex>>& M) {
    const carried_axes& axes = frame.carried.at_link(link);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        for (const joint_rate& rate : outer.rates) {
            const auto c = static_cast<std::size_t>(rate.coordinate);
            const ex h = power(axes[i], w.force, w.moment);
            M[std::max(c, i)][std::min(c, i)] += (c == i ? 2 : 1) * rate.factor * h;
        }
    }
}

/// Adds to the lower triangle of M what acceleration of one joint takes at that joint and all inward of it.
void add_joint_inertia(model_frame& frame, std::size_t accelerated, std::vector<std::vector<ex>>& M) {
    const kinematic_joint& joint = frame.tree.joints[accelerated];
    // Wrench that a unit acceleration of the joint takes, carried inward.
    wrench w = unit_wrench(frame.model, joint, frame.bodies.joint[accelerated]);
    add_coupled(joint, joint, joint.type == joint_type::revolute ? w.moment[2] : w.force[2], true, M);
    for (std::size_t link = accelerated; frame.tree.joints[link].antecedent >= 0;) {
        const std::string suffix = fmt::format("m{}_{}", joint.label, frame.tree.joints[link].label);
        w = joint_to_antecedent(frame.model, suffix, frame.axes.frames[link], w);
        link = static_cast<std::size_t>(frame.tree.joints[link].antecedent);
        if (static_cast<int>(link) == frame.meeting) {
            add_met(frame, joint, link, w, M);
            return;
        }
        const kinematic_joint& at = frame.tree.joints[link];
        add_coupled(joint, at, at.type == joint_type::revolute ? w.moment[2] : w.force[2], false, M);
        w = {frame.axes.frames[link].link_to_joint("f" + suffix, w.force),
             frame.axes.frames[link].link_to_joint("n" + suffix, w.moment)};
    }
}

}  // namespace

std::vector<std::vector<ex>> inertia_elements(model_frame& frame, const standard_parameters& parameters) {
    const kinematic_tree& tree = frame.tree;
    const auto n = static_cast<std::size_t>(tree.dof());
    std::vector<std::vector<ex>> M(n, std::vector<ex>(n, 0));
    for (std::size_t i = 0; i < tree.joints.size(); ++i) {
        if (!tree.joints[i].rates.empty()) {
            add_joint_inertia(frame, i, M);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const ex effects =
            parameters.without_elasticity(tree, effect_torque(parameters, frame.values, static_cast<int>(i)));
        for (std::size_t j = 0; j <= i; ++j) {
            const GiNaC::symbol& qdd = tree.qdd[j];  // GiNaC derives term by term also where there is none
            const ex inertia = effects.has(qdd) ? M[i][j] + effects.diff(qdd) : M[i][j];
            M[i][j] = frame.model.assign(fmt::format("M{}_{}", i + 1, j + 1), inertia);
        }
    }
    return M;
}

symbolic_model mass_matrix_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& selection, const model_form& form) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    declare_motion(model, tree, {false, false, false});
    model_frame frame(model, tree, values, merging_all(form));
    const auto M = inertia_elements(frame, parameters);
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
