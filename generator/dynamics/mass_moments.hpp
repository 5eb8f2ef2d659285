#pragma once

#include <optional>

#include "dynamics/link_frame.hpp"
#include "dynamics/parameter_values.hpp"

namespace idim::generator {

/// Distribution of the mass of one or more links, by its moments about an origin p = 0: K = sum m p p' [kg m^2],
/// S = sum m p [kg m], M = sum m [kg]. The inertia is J = tr(K) 1 - K.
struct mass_moments {
    symmetric3 K;
    vector3 S = {0, 0, 0};
    GiNaC::ex M = 0;
    /// K_xx + K_yy, the moment of inertia about z, where it is known by other means than by adding: turns about z leave
    /// it as it is.
    std::optional<GiNaC::ex> J_zz = GiNaC::ex(0);
};

/// Of one link, at the origin and in the axes of its frame.
mass_moments moments_of_link(symbolic_model& model, const parameter_values& values, int link, const std::string& label);

mass_moments add(symbolic_model& model, const std::string& name, const mass_moments& a, const mass_moments& b);

/// In axes turned by the angle about z.
mass_moments turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle,
                          const mass_moments& m);

/// What is given in a link's axes, in those of its joint: turned about z by the joint's angle.
mass_moments link_to_joint(const std::string& name, const link_frame& frame, const mass_moments& m);

/// What is given in a joint's axes, in the axes and about the origin of its antecedent.
mass_moments joint_to_antecedent(symbolic_model& model, const std::string& name, const link_frame& frame,
                                 const mass_moments& m);

/// The part that lies on the z axis, K_zz, S_z and M, and the rest. A revolute joint about z does not move the first,
/// which may as well belong to the antecedent.
mass_moments on_axis(const mass_moments& m);
mass_moments off_axis(const mass_moments& m);

bool is_zero(const mass_moments& m);

/// K_xx + K_yy.
GiNaC::ex inertia_about_z(symbolic_model& model, const mass_moments& m, const std::string& label);

}  // namespace idim::generator
