#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"
#include "idim/observation.hpp"

namespace idim {

/// Rows linearised in the parameters at `chi`, columns of `rows`, which belong to it: where links swing behind soft
/// transmissions, a parameter of theirs changes the torque by its column of W and by the twist that this column drives
/// (the equation of the twist is linear in what drives it). W becomes the derivative of the torque, and Y what makes
/// the residual of chi stay as it is: the solution is a step of Gauss and Newton, and its covariance that of the
/// parameters. What the twist changes beside the torque of inertias, some per cent of it, is left out.
observation linearised(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                       const filter_choice& choice, observation rows, const Eigen::VectorXd& chi);

}  // namespace idim
