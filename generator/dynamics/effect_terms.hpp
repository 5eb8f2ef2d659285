#pragma once

#include <vector>

#include "dynamics/standard_parameters.hpp"

namespace idim::generator {

/// The parameters of one effect at entry i of the joints it is used at, with their columns; notes in `parameters` the
/// signals, states and intervals of time that they need. None for effects without linear coefficients. Throws
/// input_error (see list_parameters).
std::vector<standard_parameter> read_terms(const kinematic_tree& tree, const effect_use& use,
                                           const effect_description& effect, std::size_t i,
                                           standard_parameters& parameters);

/// What effects of kind gain, delay and elasticity say of the drives, per coordinate. Throws input_error where a joint
/// has no coordinate of its own or a shape has a value that it cannot have.
std::vector<drive_model> read_drives(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                     const std::vector<effect_description>& descriptions);

/// Turns the tree's gravity by the effects of kind tilt: about x, then about y of the base, both [rad].
void tilt_gravity(const std::vector<effect_use>& uses, const std::vector<effect_description>& descriptions,
                  kinematic_tree& tree);

}  // namespace idim::generator
