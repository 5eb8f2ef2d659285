#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "idim/motion_limits.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// What the user says of the limits of a motion beside the robot description.
struct limit_options {
    std::vector<std::string> position;      ///< "LOW:HIGH" or "JOINT=LOW:HIGH"
    std::vector<std::string> velocity;      ///< "VALUE" or "JOINT=VALUE"
    std::vector<std::string> acceleration;  ///< likewise
    std::vector<std::string> torque;        ///< likewise
    std::string workspace;                  ///< file of boxes
    std::string parameters;                 ///< file of base parameters
};

/// Options --position, --velocity, --acceleration, --torque, --workspace, --parameters.
void add_limit_options(CLI::App& command, limit_options& options);

/// The robot under the limits of its description, what the options say put in their place. Torques are limited where
/// the base parameters are known: from --parameters, else from the a-priori parameters of the description. Throws
/// input_error where a position or velocity limit is missing or leaves no room, an option or a box names a joint that
/// the robot does not have, or the model needs what no reference tells (states of effects, closed loops). The robot
/// must outlive the result.
limited_robot limited(const loaded_robot& robot, const std::string& robot_file, const limit_options& options);

}  // namespace idim::cli
