#pragma once

#include <vector>

#include "dynamics/carried_axis.hpp"
#include "dynamics/wrench.hpp"

namespace idim::generator {

/// What the models of one robot have in common: where quantities are written, for which bodies, and in which form.
struct model_frame {
    model_frame(symbolic_model& model, const kinematic_tree& tree, const parameter_values& values,
                const model_form& form);

    symbolic_model& model;
    const kinematic_tree& tree;
    const parameter_values& values;
    model_form form;
    link_axes axes;
    link_bodies bodies;
    axis_recursion carried;
    int meeting = -1;  ///< the link where wrenches from outward are met by the axes of all joints before, -1 for none
};

/// Torques [n] of the rigid links by recursive Newton-Euler (Luh, Walker and Paul 1980), with the part of the motion
/// `inputs` has.
std::vector<GiNaC::ex> joint_torques(model_frame& frame, const motion_inputs& inputs);

/// The torque of an effect at qdd = 0.
GiNaC::ex without_acceleration(const GiNaC::ex& torque, const kinematic_tree& tree);

}  // namespace idim::generator
