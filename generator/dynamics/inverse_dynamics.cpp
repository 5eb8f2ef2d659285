#include "dynamics/inverse_dynamics.hpp"

#include "dynamics/dynamic_models.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

class torque_recursion {
  public:
    torque_recursion(model_frame& frame, const motion_inputs& inputs)
        : frame_(frame),
          model_(frame.model),
          inputs_(inputs),
          motion_(frame.model, frame.tree, frame.axes, inputs),
          arriving_(frame.tree.joints.size()),
          torque_(static_cast<std::size_t>(frame.tree.dof()), 0) {}

    std::vector<ex> run() {
        for (std::size_t j = frame_.tree.joints.size(); j-- > 0;) {
            const bool merged = is_merged(frame_.tree, frame_.axes, frame_.form, j);
            wrench total = arriving_[j];
            if (!merged) {
                total = add(model_, frame_.tree.joints[j].label, own_wrench(j), total);
            }
            if (static_cast<int>(j) == frame_.meeting) {
                meet(j, total);
                total = {};
            }
            const wrench before_turn = merged ? with_joint(j, total) : turned(j, total);
            bear(j, before_turn);
            hand_on(j, before_turn);
        }
        for (std::size_t i = 0; i < torque_.size(); ++i) {
            torque_[i] = model_.assign("rigid" + std::to_string(i + 1), torque_[i]);
        }
        return std::move(torque_);
    }

  private:
    const std::string& label(std::size_t j) const { return frame_.tree.joints[j].label; }

    wrench own_wrench(std::size_t j) {
        const bool by_moments =
            frame_.form.second_moments || frame_.form.parallel_axes || frame_.form.merged != model_form::merging::none;
        return by_moments ? wrench_of_body(model_, motion_.of_link(j), frame_.bodies.link[j], label(j))
                          : wrench_of_link(model_, motion_.of_link(j), frame_.values, static_cast<int>(j), label(j));
    }

    /// The torques of all joints inward, and of the link's own, from the wrench that moves what is outward.
    void meet(std::size_t j, const wrench& total) {
        const carried_axes& axes = frame_.carried.at_link(j);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            torque_[i] += power(axes[i], total.force, total.moment);
        }
    }

    wrench turned(std::size_t j, const wrench& total) const {
        const link_frame& frame = frame_.axes.frames[j];
        return {frame.link_to_joint("fa" + label(j), total.force), frame.link_to_joint("na" + label(j), total.moment)};
    }

    wrench with_joint(std::size_t j, const wrench& total) {
        const kinematic_joint& joint = frame_.tree.joints[j];
        const wrench before_turn = turned(j, total);
        if (joint.rates.empty()) {
            return before_turn;
        }
        const carrying_motion under = motion_.under_joint(j);
        const joint_rates rates = rates_of(model_, frame_.tree, j, inputs_);
        add_to_rows(joint, carried_torque(model_, joint, under, frame_.bodies.joint[j]));
        return add(model_, "d" + label(j), before_turn,
                   added_wrench(model_, joint, under, rates, frame_.bodies.joint[j]));
    }

    void bear(std::size_t j, const wrench& w) {
        const kinematic_joint& joint = frame_.tree.joints[j];
        add_to_rows(joint, joint.type == joint_type::revolute ? w.moment[2] : w.force[2]);
    }

    void add_to_rows(const kinematic_joint& joint, const ex& torque) {
        for (const joint_rate& rate : joint.rates) {
            torque_[static_cast<std::size_t>(rate.coordinate)] += rate.factor * torque;
        }
    }

    void hand_on(std::size_t j, const wrench& w) {
        const int antecedent = frame_.tree.joints[j].antecedent;
        if (antecedent >= 0) {
            wrench& before = arriving_[static_cast<std::size_t>(antecedent)];
            before = add(model_, "s" + label(j), before,
                         joint_to_antecedent(model_, "b" + label(j), frame_.axes.frames[j], w));
        }
    }

    model_frame& frame_;
    symbolic_model& model_;
    motion_inputs inputs_;
    motion_recursion motion_;
    std::vector<wrench> arriving_;  ///< at each link, from the links outward
    std::vector<ex> torque_;
};

}  // namespace

model_frame::model_frame(symbolic_model& symbolic, const kinematic_tree& of, const parameter_values& known,
                         const model_form& written)
    : model(symbolic),
      tree(of),
      values(known),
      form(written),
      axes(lay_axes(symbolic, of, written)),
      bodies(gather_bodies(symbolic, of, axes, known, written)),
      carried(symbolic, of, axes),
      meeting(written.meeting ? last_before_wrist(of) : -1) {}

std::vector<ex> joint_torques(model_frame& frame, const motion_inputs& inputs) {
    return torque_recursion(frame, inputs).run();
}

namespace {

/// The torque as a drive with an error of its gain records it.
ex scaled(symbolic_model& model, const ex& gain, const std::string& name, const ex& torque) {
    return gain.is_equal(1) ? model.assign(name, torque)
                            : model.assign(name, gain * model.assign(name + "_joint", torque));
}

symbolic_model torque_model(const kinematic_tree& tree, const standard_parameters& parameters,
                            const parameter_selection& selection, const model_form& form, const motion_inputs& inputs,
                            const std::string& array) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    declare_signals(model, parameters);
    declare_motion(model, tree, inputs);
    model_frame frame(model, tree, values, form);
    const std::vector<ex> torque = joint_torques(frame, inputs);
    const bool with_effects = inputs.velocity;
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
                                      const parameter_selection& selection, const model_form& form) {
    return torque_model(tree, parameters, selection, form, {true, true, true}, "tau");
}

symbolic_model bias_model(const kinematic_tree& tree, const standard_parameters& parameters,
                          const parameter_selection& selection, const model_form& form) {
    return torque_model(tree, parameters, selection, form, {true, false, true}, "N");
}

symbolic_model rigid_torque_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                  const parameter_selection& selection, const model_form& form) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    declare_motion(model, tree, {});
    model_frame frame(model, tree, values, form);
    const std::vector<ex> torque = joint_torques(frame, {});
    for (std::size_t i = 0; i < torque.size(); ++i) {
        model.output("tau_rigid", static_cast<int>(i), model.assign("rigid" + std::to_string(i + 1), torque[i]));
    }
    return model;
}

symbolic_model gravity_model(const kinematic_tree& tree, const standard_parameters& parameters,
                             const parameter_selection& selection, const model_form& form) {
    return torque_model(tree, parameters, selection, form, {false, false, true}, "G");
}

}  // namespace idim::generator
