#pragma once

#include "instrumental_variable/loop_simulator.hpp"

namespace idim {

/// loop_method::cloe: chi that minimises the squared difference of measured and simulated position, joints weighted by
/// their own deviation, through Gauss-Newton steps that are halved while they make it worse. Sensitivities by forward
/// differences, b + 1 simulations a step. Deviations are those of the linearised least squares in the positions.
estimate fit_positions(const loop_simulator& simulator, const Eigen::VectorXd& start, const loop_options& options);

}  // namespace idim
