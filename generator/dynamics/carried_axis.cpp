#include "dynamics/carried_axis.hpp"

#include <fmt/format.h>

namespace idim::generator {

bool is_zero(const carried_axis& axis) {
    return is_zero(axis.e) && is_zero(axis.m);
}

GiNaC::ex power(const carried_axis& axis, const vector3& force, const vector3& moment) {
    return dot(axis.e, moment) + dot(axis.m, force);
}

const carried_axes& axis_recursion::at_link(std::size_t link) {
    if (links_[link].empty()) {
        links_[link] = step(link);
    }
    return links_[link];
}

carried_axes axis_recursion::under_joint(std::size_t joint) {
    const kinematic_joint& of = tree_.joints[joint];
    if (of.antecedent < 0) {
        return carried_axes(static_cast<std::size_t>(tree_.dof()));
    }
    carried_axes axes = at_link(static_cast<std::size_t>(of.antecedent));
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (!is_zero(axes[i])) {
            axes[i].m = model_.assign(fmt::format("mc{}_{}", i + 1, of.label),
                                      add(axes[i].m, cross(axes[i].e, axes_.frames[joint].position())));
        }
    }
    return axes;
}

carried_axes axis_recursion::step(std::size_t link) {
    const kinematic_joint& joint = tree_.joints[link];
    const link_frame& frame = axes_.frames[link];
    carried_axes axes = under_joint(link);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::string suffix = fmt::format("{}_{}", i + 1, joint.label);
        axes[i] = {frame.to_link("e" + suffix, axes[i].e), frame.to_link("m" + suffix, axes[i].m)};
    }
    const bool turns = joint.type == joint_type::revolute;
    for (const joint_rate& rate : joint.rates) {
        carried_axis& axis = axes[static_cast<std::size_t>(rate.coordinate)];
        GiNaC::ex& along = turns ? axis.e[2] : axis.m[2];
        along = model_.assign(fmt::format("{}{}_{}_3", turns ? "eo" : "mo", rate.coordinate + 1, joint.label),
                              along + rate.factor);
    }
    return axes;
}

}  // namespace idim::generator
