#pragma once

#include <string>
#include <vector>

#include "dynamics/model_form.hpp"
#include "dynamics/standard_parameters.hpp"
#include "dynamics/symbolic_model.hpp"

namespace idim::generator {

/// The standard parameters a model is written in; all others are zero in it. Entry k is argument chi[k].
struct parameter_selection {
    std::vector<std::size_t> kept;   ///< into standard_parameters::all
    std::vector<std::string> names;  ///< as they appear in formulas and code, such as ZZ1R
};

/// W [n x b], row-major: tau = W(q, qd, qdd) chi [IV 2]. Output array "W".
symbolic_model regressor_model(const kinematic_tree& tree, const standard_parameters& parameters,
                               const parameter_selection& selection, const model_form& form);

/// tau [n] = M(q) qdd + N(q, qd) [IV 1], recursive Newton-Euler. Output array "tau".
symbolic_model inverse_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection, const model_form& form);

/// N [n]: the torque at qdd = 0. Output array "N".
symbolic_model bias_model(const kinematic_tree& tree, const standard_parameters& parameters,
                          const parameter_selection& selection, const model_form& form);

/// G [n]: the torque of the rigid links at rest. Output array "G".
symbolic_model gravity_model(const kinematic_tree& tree, const standard_parameters& parameters,
                             const parameter_selection& selection, const model_form& form);

/// M [n x n], row-major, symmetric; what effects contribute per unit of qdd included. Output array "M".
symbolic_model mass_matrix_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& selection, const model_form& form);

/// qdd [n] = M^-1 (tau - N) [IV 21] by M = L' D L. Output arrays "qdd" and "D" [n], the pivots: all positive if and
/// only if M is positive definite.
symbolic_model forward_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection, const model_form& form);

}  // namespace idim::generator
