#pragma once

#include "dynamics/link_bodies.hpp"
#include "dynamics/link_motion.hpp"

namespace idim::generator {

/// Force, and moment about an origin.
struct wrench {
    vector3 force = {0, 0, 0};
    vector3 moment = {0, 0, 0};
};

wrench add(symbolic_model& model, const std::string& name, const wrench& a, const wrench& b);

/// From a joint's axes to the axes and the origin of its antecedent.
wrench joint_to_antecedent(symbolic_model& model, const std::string& name, const link_frame& frame, const wrench& w);

/// Wrench that moves a body, at the origin: f = M VP + U S and n with skew(n) = U K - (U K)' + skew(S x VP).
wrench wrench_of_body(symbolic_model& model, const link_motion& motion, const mass_moments& body,
                      const std::string& label);

/// The same for one link by its inertia, n = J WP + W x (J W) + S x VP, differences of diagonal inertias folded into
/// one parameter.
wrench wrench_of_link(symbolic_model& model, const link_motion& motion, const parameter_values& values, int link,
                      const std::string& label);

/// Wrench that moves a body with the antecedent of its joint: the component of it that the joint bears.
GiNaC::ex carried_torque(symbolic_model& model, const kinematic_joint& joint, const carrying_motion& motion,
                         const mass_moments& body);

/// What moving the joint adds to that wrench, in the joint's axes.
///
/// For a joint that turns, U of the body less U of the antecedent is [-e -a 0; a -e 0; gx gy 0] with the joint's
/// velocity w and acceleration a, e = w (2 Wz + w) and g = 2 w (Wx, Wy), W the antecedent's.
wrench added_wrench(symbolic_model& model, const kinematic_joint& joint, const carrying_motion& motion,
                    const joint_rates& rates, const mass_moments& body);

/// Wrench of a body that takes unit acceleration of its joint, everything else at rest.
wrench unit_wrench(symbolic_model& model, const kinematic_joint& joint, const mass_moments& body);

}  // namespace idim::generator
