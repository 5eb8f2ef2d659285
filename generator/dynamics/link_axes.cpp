#include "dynamics/link_axes.hpp"

#include <fmt/format.h>

namespace idim::generator {

namespace {

bool is_parallel(const kinematic_joint& joint) {
    return is_identity(joint.gamma) && is_identity(joint.alpha);
}

std::vector<bool> tips(const kinematic_tree& tree) {
    std::vector<bool> result(tree.joints.size(), true);
    for (const kinematic_joint& joint : tree.joints) {
        if (joint.antecedent >= 0) {
            result[static_cast<std::size_t>(joint.antecedent)] = false;
        }
    }
    return result;
}

/// Cosine and sine of a joint's own angle, named; constant ones as they are.
angle_pair own_angle(symbolic_model& model, const kinematic_joint& joint) {
    return {model.assign("C" + joint.label, joint.theta.cos), model.assign("S" + joint.label, joint.theta.sin)};
}

angle_pair sum(symbolic_model& model, const std::string& label, const angle_pair& a, const angle_pair& b) {
    if (is_identity(a)) {
        return b;
    }
    return {model.assign("C" + label, a.cos * b.cos - a.sin * b.sin),
            model.assign("S" + label, a.sin * b.cos + a.cos * b.sin)};
}

/// All joints that follow immediately have axes parallel to the link's own.
bool precedes_parallel_axes(const kinematic_tree& tree, std::size_t link) {
    bool any = false;
    for (const kinematic_joint& joint : tree.joints) {
        if (joint.antecedent == static_cast<int>(link)) {
            any = true;
            if (!is_parallel(joint)) {
                return false;
            }
        }
    }
    return any;
}

/// The link may keep the axes of its antecedent, the next joints turning by the sum of the angles.
bool adds_angles(const kinematic_tree& tree, std::size_t link) {
    const kinematic_joint& joint = tree.joints[link];
    return joint.type == joint_type::revolute && joint.antecedent >= 0 && precedes_parallel_axes(tree, link);
}

}  // namespace

bool has_parallel_axes(const kinematic_tree& tree) {
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        if (adds_angles(tree, j)) {
            return true;
        }
    }
    return false;
}

int last_before_wrist(const kinematic_tree& tree) {
    const auto moves_origin = [&tree](int joint) {
        const auto position = tree.joints[static_cast<std::size_t>(joint)].position();
        return !is_zero(position);
    };
    for (int j = static_cast<int>(tree.joints.size()) - 1; j >= 2; --j) {
        const int first = tree.joints[static_cast<std::size_t>(j)].antecedent;  // of the wrist
        if (first >= 0 && moves_origin(first) && !moves_origin(j)) {
            const int link = tree.joints[static_cast<std::size_t>(first)].antecedent;
            return link >= 0 && tree.joints[static_cast<std::size_t>(link)].antecedent >= 0 ? link : -1;
        }
    }
    return -1;
}

link_axes lay_axes(symbolic_model& model, const kinematic_tree& tree, const model_form& form) {
    link_axes axes;
    axes.is_tip = tips(tree);
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        const kinematic_joint& joint = tree.joints[j];
        const angle_pair before =
            joint.antecedent < 0 ? angle_pair{} : axes.lag[static_cast<std::size_t>(joint.antecedent)];
        const angle_pair total = sum(model, joint.label + "_sum", before, own_angle(model, joint));
        const std::string name = "P" + joint.label;
        const vector3 position = model.assign(name, joint.position());
        const bool revolute = joint.type == joint_type::revolute;
        const bool keeps = (form.parallel_axes && adds_angles(tree, j)) ||
                           (form.merged == model_form::merging::tips && revolute && axes.is_tip[j]);
        axes.frames.emplace_back(model, joint, keeps ? angle_pair{} : total,
                                 turn_about_z(model, name + "_turned", before, position));
        axes.in_own_frame.emplace_back(model, joint, angle_pair{}, position);
        axes.lag.push_back(keeps ? total : angle_pair{});
    }
    return axes;
}

}  // namespace idim::generator
