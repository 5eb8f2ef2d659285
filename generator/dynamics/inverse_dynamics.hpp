#pragma once

#include <vector>

#include "dynamics/link_motion.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

/// Torques [n] of the rigid links by recursive Newton-Euler (Luh, Walker and Paul 1980), with the part of the motion
/// `inputs` has.
std::vector<GiNaC::ex> joint_torques(symbolic_model& model, const kinematic_tree& tree,
                                     const std::vector<link_frame>& frames, const parameter_values& values,
                                     const motion_inputs& inputs);

/// The torque of an effect at qdd = 0.
GiNaC::ex without_acceleration(const GiNaC::ex& torque, const kinematic_tree& tree);

}  // namespace idim::generator
