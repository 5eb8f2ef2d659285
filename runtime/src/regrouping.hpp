#pragma once

#include <Eigen/Core>

#include "idim/model_interface.h"

namespace idim {

/// Base parameters per unit of each standard one, b x s: chi = R times the standard parameters.
Eigen::MatrixXd regrouping_of(const idim_model_interface& model);

}  // namespace idim
