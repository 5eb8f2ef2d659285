#pragma once

#include "dynamics/dynamic_models.hpp"

namespace idim::generator {

/// w [p] of the standard parameters: w = v' W(q, qd, qdd), so that w chi is the power of the torques at virtual
/// velocities v [n] of the coordinates (Jourdain's principle). The same columns as the standard regressor W [n x p] in
/// equations whose number grows with the links, not with their square; v = unit vector i gives row i of W. Output array
/// "w"; v stands behind all other leaves.
symbolic_model virtual_power_model(const kinematic_tree& tree, const standard_parameters& parameters);

}  // namespace idim::generator
