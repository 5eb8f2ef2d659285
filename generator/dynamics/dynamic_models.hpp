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

// What effects change beside adding torques: the rows of a joint whose drive has an error of its gain are scaled, in M
// too; the inertial parameters of links and the torque of gravity are those with the payloads that are on. Where
// effects depend on the torque of the links alone, the regressor and the direct model take it as a leaf.

/// W [n x b], row-major: tau = W(q, qd, qdd) chi [IV 2]. Output array "W".
symbolic_model regressor_model(const kinematic_tree& tree, const standard_parameters& parameters,
                               const parameter_selection& selection, const model_form& form);

/// tau [n] = M(q) qdd + N(q, qd) [IV 1], recursive Newton-Euler. Output array "tau".
symbolic_model inverse_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection, const model_form& form);

/// The torque [n] of the links and payloads alone, without effects, gain errors and what effects add to base
/// parameters of their own. Output array "tau_rigid".
symbolic_model rigid_torque_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                  const parameter_selection& selection, const model_form& form);

/// The states of effects: at the first sample, output array "start" [s]; at the sample that follows, "next" [s].
/// Written the same in every form.
symbolic_model first_states_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                  const parameter_selection& selection, const model_form& form);
symbolic_model next_states_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& selection, const model_form& form);

/// How well the loops close: kinematic_tree::closures [loops], output array "closed". Written the same in every form.
symbolic_model closure_model(const kinematic_tree& tree, const standard_parameters& parameters,
                             const parameter_selection& selection, const model_form& form);

/// N [n]: the torque at qdd = 0. Output array "N".
symbolic_model bias_model(const kinematic_tree& tree, const standard_parameters& parameters,
                          const parameter_selection& selection, const model_form& form);

/// G [n]: the torque of the rigid links at rest. Output array "G".
symbolic_model gravity_model(const kinematic_tree& tree, const standard_parameters& parameters,
                             const parameter_selection& selection, const model_form& form);

/// M [n x n], row-major, symmetric but for gain errors; what effects contribute per unit of qdd included. Output array
/// "M".
symbolic_model mass_matrix_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                 const parameter_selection& selection, const model_form& form);

/// qdd [n] = M^-1 (tau - N) [IV 21] by M = L' D L. Output arrays "qdd" and "D" [n], the pivots: all positive if and
/// only if M is positive definite.
symbolic_model forward_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection, const model_form& form);

}  // namespace idim::generator
