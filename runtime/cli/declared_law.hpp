#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "idim/control_law.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// The law under `control` of a robot description, tuned for `chi` [b]. Throws input_error where there is none, or
/// make_control_law refuses it.
std::unique_ptr<control_law> declared_law(const std::string& robot_file, const loaded_robot& robot,
                                          const Eigen::VectorXd& chi);

}  // namespace idim::cli
