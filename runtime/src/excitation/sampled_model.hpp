#pragma once

#include <Eigen/Core>

#include "idim/fourier_series.hpp"
#include "idim/model_interface.h"

namespace idim {

/// Regressors of all samples, samples x (n b), column = joint * b + parameter. Signals beside the motion are 20 degC
/// for temperatures and 0 for all else.
Eigen::MatrixXd sampled_regressor(const idim_model_interface& model, const motion_samples& motion);

/// Torques of all samples, samples x n.
Eigen::MatrixXd sampled_torque(const idim_model_interface& model, const motion_samples& motion,
                               const Eigen::VectorXd& chi);

}  // namespace idim
