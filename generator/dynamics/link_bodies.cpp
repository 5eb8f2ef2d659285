#include "dynamics/link_bodies.hpp"

namespace idim::generator {

bool is_merged(const kinematic_tree& tree, const link_axes& axes, const model_form& form, std::size_t joint) {
    switch (form.merged) {
        case model_form::merging::none:
            return false;
        case model_form::merging::tips:
            return axes.is_tip[joint] && tree.joints[joint].type == joint_type::revolute &&
                   !axes.frames[joint].keeps_z();
        case model_form::merging::all:
            break;
    }
    return true;
}

namespace {

/// The own moments of each link. What lies on the axis of a revolute joint is moved to the antecedent, to and from axes
/// that the joint has not turned: with constant geometry only parameters are added to each other.
std::vector<mass_moments> own_moments(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes,
                                      const parameter_values& values, const model_form& form) {
    std::vector<mass_moments> own;
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        own.push_back(moments_of_link(model, values, static_cast<int>(j), tree.joints[j].label));
    }
    for (std::size_t j = own.size(); form.second_moments && j-- > 0;) {
        const kinematic_joint& joint = tree.joints[j];
        const mass_moments axial = on_axis(own[j]);
        if (joint.type != joint_type::revolute || is_zero(axial)) {
            continue;
        }
        own[j] = off_axis(own[j]);
        if (joint.antecedent >= 0) {
            mass_moments& before = own[static_cast<std::size_t>(joint.antecedent)];
            before = add(model, joint.label + "_axis_sum", before,
                         joint_to_antecedent(model, joint.label + "_axis", axes.in_own_frame[j], axial));
        }
    }
    return own;
}

}  // namespace

link_bodies gather_bodies(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes,
                          const parameter_values& values, const model_form& form) {
    link_bodies bodies;
    const std::vector<mass_moments> own = own_moments(model, tree, axes, values, form);
    const std::size_t n = tree.joints.size();
    bodies.joint.resize(n);
    for (std::size_t j = 0; j < n; ++j) {
        bodies.link.push_back(turn_about_z(model, tree.joints[j].label + "_own", axes.lag[j], own[j]));
    }
    for (std::size_t j = n; j-- > 0;) {
        const kinematic_joint& joint = tree.joints[j];
        mass_moments handed;
        if (is_merged(tree, axes, form, j)) {
            bodies.link[j].J_zz = inertia_about_z(model, bodies.link[j], joint.label);  // before it is turned
            handed = bodies.joint[j] = link_to_joint(joint.label + "_turned", axes.frames[j], bodies.link[j]);
        } else if (form.second_moments && joint.type == joint_type::revolute) {
            handed = on_axis(bodies.link[j]);
            bodies.link[j] = off_axis(bodies.link[j]);
        }
        if (joint.antecedent >= 0 && !is_zero(handed)) {
            mass_moments& before = bodies.link[static_cast<std::size_t>(joint.antecedent)];
            before = add(model, joint.label + "_sum", before,
                         joint_to_antecedent(model, joint.label, axes.frames[j], handed));
        }
    }
    return bodies;
}

}  // namespace idim::generator
