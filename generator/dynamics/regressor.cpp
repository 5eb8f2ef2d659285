#include <fmt/format.h>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// A joint's axis as a link further out sees it: tau_i = e . n + m . f for a force f and a moment n at that link's
/// origin. Carrying these two vectors outward and dotting them with the sparse columns of a link's parameters takes
/// fewer operations than carrying the wrench of every parameter inward.
struct carried_axis {
    vector3 e;  ///< axis of a revolute joint, zero for a prismatic one
    vector3 m;  ///< moment arm: e x (from the joint's origin to the link's), or the axis of a prismatic joint
};

/// Adds the joint's own axis, scaled by the rate at which the coordinate moves the joint.
void add_own_axis(symbolic_model& model, const kinematic_joint& joint, const joint_rate& rate, carried_axis& axis) {
    vector3& part = joint.type == joint_type::revolute ? axis.e : axis.m;
    const char* const name = joint.type == joint_type::revolute ? "eo" : "mo";
    part[2] = model.assign(fmt::format("{}{}_{}_3", name, rate.coordinate + 1, joint.label), part[2] + rate.factor);
}

carried_axis carry(symbolic_model& model, const link_frame& frame, const carried_axis& axis,
                   const std::string& suffix) {
    const vector3 arm = model.assign("mc" + suffix, add(axis.m, cross(axis.e, frame.position())));
    return {frame.to_link("e" + suffix, axis.e), frame.to_link("m" + suffix, arm)};
}

/// Moments that a unit of each inertia parameter causes at the link's origin: J WP + W x (J W), in terms of U.
vector3 inertia_column(symbolic_model& model, const link_motion& link, parameter_kind kind, const std::string& label) {
    const auto& U = link.U;
    const auto difference = [&](const char* name, const ex& value) { return model.assign(name + label, value); };
    switch (kind) {
        case parameter_kind::XX:
            return {link.WP[0], link.WxWz, -link.WxWy};
        case parameter_kind::XY:
            return {-U[2][0], U[2][1], difference("U1122_", link.WxWx - link.WyWy)};
        case parameter_kind::XZ:
            return {U[1][0], difference("U3311_", link.WzWz - link.WxWx), -U[1][2]};
        case parameter_kind::YY:
            return {-link.WyWz, link.WP[1], link.WxWy};
        case parameter_kind::YZ:
            return {difference("U2233_", link.WyWy - link.WzWz), -U[0][1], U[0][2]};
        default:
            return {link.WyWz, -link.WxWz, link.WP[2]};
    }
}

ex column(symbolic_model& model, const link_motion& link, const carried_axis& axis, parameter_kind kind,
          const std::string& label) {
    if (kind == parameter_kind::M) {
        return dot(axis.m, link.VP);
    }
    if (kind >= parameter_kind::MX) {
        const auto i = static_cast<std::size_t>(kind) - static_cast<std::size_t>(parameter_kind::MX);
        const vector3 lever = cross(link.VP, axis.e);
        return lever[i] + link.U[0][i] * axis.m[0] + link.U[1][i] * axis.m[1] + link.U[2][i] * axis.m[2];
    }
    return dot(axis.e, inertia_column(model, link, kind, label));
}

class regressor_builder {
  public:
    regressor_builder(const kinematic_tree& tree, const standard_parameters& parameters,
                      const parameter_selection& selection)
        : tree_(tree), parameters_(parameters), selection_(selection), model_(tree) {}

    symbolic_model run() {
        declare_gates(model_, parameters_);
        declare_signals(model_, parameters_);
        declare_rigid_torque(model_, parameters_);
        frames_ = declare_motion(model_, tree_, {});
        links_ = propagate_motion(model_, tree_, frames_, {});
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            carry_axes_to(j);
            for (int row = 0; row < tree_.dof(); ++row) {
                add_row(row, static_cast<int>(j));
            }
        }
        return std::move(model_);
    }

  private:
    void carry_axes_to(std::size_t j) {
        const kinematic_joint& joint = tree_.joints[j];
        std::vector<carried_axis> axes(static_cast<std::size_t>(tree_.dof()), {{0, 0, 0}, {0, 0, 0}});
        if (joint.antecedent >= 0) {
            const auto& before = axes_[static_cast<std::size_t>(joint.antecedent)];
            for (std::size_t i = 0; i < before.size(); ++i) {
                if (!is_zero(before[i].e) || !is_zero(before[i].m)) {
                    axes[i] = carry(model_, frames_[j], before[i], fmt::format("{}_{}", i + 1, joint.label));
                }
            }
        }
        for (const joint_rate& rate : joint.rates) {
            add_own_axis(model_, joint, rate, axes[static_cast<std::size_t>(rate.coordinate)]);
        }
        axes_.push_back(axes);
    }

    void add_row(int row, int link) {
        const carried_axis& axis = axes_[static_cast<std::size_t>(link)][static_cast<std::size_t>(row)];
        const std::string& label = tree_.joints[static_cast<std::size_t>(link)].label;
        for (std::size_t k = 0; k < selection_.kept.size(); ++k) {
            const standard_parameter& parameter = parameters_.all[selection_.kept[k]];
            if (parameter.joint != link) {
                continue;
            }
            ex value = parameter.kind != parameter_kind::effect
                           ? column(model_, links_[static_cast<std::size_t>(link)], axis, parameter.kind, label)
                           : parameter.column_at(row);
            value *= parameters_.drives[static_cast<std::size_t>(row)].gain;
            value *= parameter.gate >= 0 ? gate_of(parameters_, parameter) : ex(1);
            const std::string name = fmt::format("W{}_{}", row + 1, selection_.names[k]);
            model_.output("W", row * static_cast<int>(selection_.kept.size()) + static_cast<int>(k),
                          model_.assign(name, value));
        }
    }

    const kinematic_tree& tree_;
    const standard_parameters& parameters_;
    const parameter_selection& selection_;
    symbolic_model model_;
    std::vector<link_frame> frames_;
    std::vector<link_motion> links_;
    std::vector<std::vector<carried_axis>> axes_;
};

}  // namespace

symbolic_model regressor_model(const kinematic_tree& tree, const standard_parameters& parameters,
                               const parameter_selection& selection) {
    return regressor_builder(tree, parameters, selection).run();
}

}  // namespace idim::generator
