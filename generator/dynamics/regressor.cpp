#include <fmt/format.h>

#include "dynamics/carried_axis.hpp"
#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_motion.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Moments that a unit of each inertia parameter causes at the link's origin: J WP + W x (J W), in terms of U.
vector3 inertia_column(symbolic_model& model, const link_motion& link, parameter_kind kind, const std::string& label) {
    const auto& U = link.U;
    const auto difference = [&](const char* name, const ex& value) { return model.assign(name + label, value); };
    switch (kind) {
        case parameter_kind::XX:
            return {link.WP[0], link.WxWz, -link.WxWy};
        case parameter_kind::XY:
            return {-U[2][0], U[2][1], difference("U1122_", link.squares[0] - link.squares[1])};
        case parameter_kind::XZ:
            return {U[1][0], difference("U3311_", link.squares[2] - link.squares[0]), -U[1][2]};
        case parameter_kind::YY:
            return {-link.WyWz, link.WP[1], link.WxWy};
        case parameter_kind::YZ:
            return {difference("U2233_", link.squares[1] - link.squares[2]), -U[0][1], U[0][2]};
        default:
            return {link.WyWz, -link.WxWz, link.WP[2]};
    }
}

/// Carries joints' axes outward and dots them with the sparse columns of a link's parameters, which takes fewer
/// operations than carrying the wrench of every parameter inward.
class regressor_builder {
  public:
    regressor_builder(const kinematic_tree& tree, const standard_parameters& parameters,
                      const parameter_selection& selection, const model_form& form)
        : tree_(tree), parameters_(parameters), selection_(selection), form_(form), model_(tree) {}

    symbolic_model run() {
        declare_gates(model_, parameters_);
        declare_signals(model_, parameters_);
        declare_rigid_torque(model_, parameters_);
        declare_motion(model_, tree_, {});
        axes_ = lay_axes(model_, tree_, {});  // those of the links' frames, in which their parameters are given
        const motion_recursion motion(model_, tree_, axes_, {});
        axis_recursion carried(model_, tree_, axes_);
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            if (form_.meeting && tree_.joints[j].type != joint_type::prismatic) {
                const std::size_t met = first_at_same_point(j);
                add_link(j, motion.of_link(j), carried.at_link(j), carried.under_joint(met), static_cast<int>(met));
            } else {
                add_link(j, motion.of_link(j), carried.at_link(j), carried.at_link(j), -1);
            }
        }
        return std::move(model_);
    }

  private:
    /// The innermost joint of those that turn about a link's origin.
    std::size_t first_at_same_point(std::size_t link) const {
        std::size_t first = link;
        while (tree_.joints[first].antecedent >= 0 && is_zero(axes_.frames[first].position()) &&
               tree_.joints[static_cast<std::size_t>(tree_.joints[first].antecedent)].type != joint_type::prismatic) {
            first = static_cast<std::size_t>(tree_.joints[first].antecedent);
        }
        return first;
    }

    /// A force in a link's axes, in those of the antecedent of the joint where it is met, or as it is for -1.
    vector3 met_force(const std::string& name, std::size_t link, int met, vector3 force) const {
        int j = static_cast<int>(link);
        for (int turned = -1; met >= 0 && turned != met;
             turned = j, j = tree_.joints[static_cast<std::size_t>(j)].antecedent) {
            const auto at = static_cast<std::size_t>(j);
            force = axes_.frames[at].to_antecedent(name + "_" + tree_.joints[at].label, force);
        }
        return force;
    }

    /// Columns of one link: `axes` as it sees them, `arms` in the axes in which forces are met.
    void add_link(std::size_t link, const link_motion& motion, const carried_axes& axes, const carried_axes& arms,
                  int met) {
        for (std::size_t k = 0; k < selection_.kept.size(); ++k) {
            const standard_parameter& parameter = parameters_.all[selection_.kept[k]];
            if (parameter.joint != static_cast<int>(link)) {
                continue;
            }
            const std::string& name = selection_.names[k];
            const std::string& label = tree_.joints[link].label;
            if (parameter.kind == parameter_kind::effect) {
                add_column(k, [&](std::size_t row) { return parameter.column_at(static_cast<int>(row)); });
            } else if (parameter.kind < parameter_kind::MX) {
                const vector3 moment = inertia_column(model_, motion, parameter.kind, label);
                add_column(k, [&](std::size_t row) { return dot(axes[row].e, moment); });
            } else if (parameter.kind == parameter_kind::M) {
                const vector3 force = met_force("fM" + name, link, met, motion.VP);
                add_column(k, [&](std::size_t row) { return dot(arms[row].m, force); });
            } else {
                const auto i = static_cast<std::size_t>(parameter.kind) - static_cast<std::size_t>(parameter_kind::MX);
                const vector3 force =
                    met_force("fM" + name, link, met, {motion.U[0][i], motion.U[1][i], motion.U[2][i]});
                add_column(k,
                           [&](std::size_t row) { return cross(motion.VP, axes[row].e)[i] + dot(arms[row].m, force); });
            }
        }
    }

    template <class Rows>
    void add_column(std::size_t k, const Rows& rows) {
        const standard_parameter& parameter = parameters_.all[selection_.kept[k]];
        const ex gate = parameter.gate >= 0 ? gate_of(parameters_, parameter) : ex(1);
        for (std::size_t row = 0; row < static_cast<std::size_t>(tree_.dof()); ++row) {
            const ex value = gate * parameters_.drives[row].gain * rows(row);
            model_.output("W", static_cast<int>(row * selection_.kept.size() + k),
                          model_.assign(fmt::format("W{}_{}", row + 1, selection_.names[k]), value));
        }
    }

    const kinematic_tree& tree_;
    const standard_parameters& parameters_;
    const parameter_selection& selection_;
    model_form form_;
    symbolic_model model_;
    link_axes axes_;
};

}  // namespace

symbolic_model regressor_model(const kinematic_tree& tree, const standard_parameters& parameters,
                               const parameter_selection& selection, const model_form& form) {
    return regressor_builder(tree, parameters, selection, form).run();
}

}  // namespace idim::generator
