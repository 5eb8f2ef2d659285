#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "description/robot_description.hpp"
#include "idim/law_declaration.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// The `control` of a robot description, a law of the user's own compiled. Throws input_error where its header is
/// missing or does not compile.
law_declaration law_declaration_of(const generator::control_description& control);

/// The law under `control` of a robot description, tuned for `chi` [b]. Throws input_error where there is none, or
/// make_control_law refuses it.
std::unique_ptr<control_law> declared_law(const std::string& robot_file, const loaded_robot& robot,
                                          const Eigen::VectorXd& chi);

}  // namespace idim::cli
