#pragma once

#include <Eigen/Core>
#include <array>

#include "idim/model_interface.h"

namespace idim {

/// The standard parameters of a link by their names less its number, in order, and their units.
constexpr std::array<const char*, 10> inertial_names = {"XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"};
constexpr std::array<const char*, 10> inertial_units = {"kg*m^2", "kg*m^2", "kg*m^2", "kg*m^2", "kg*m^2",
                                                        "kg*m^2", "kg*m",   "kg*m",   "kg*m",   "kg"};

/// Columns of a regrouping that belong to the ten inertial parameters of the link of `joint`, b x 10; zero where the
/// robot has no such parameter.
Eigen::MatrixXd link_columns(const idim_model_interface& model, const Eigen::MatrixXd& regrouping, int joint);

}  // namespace idim
