#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// What a result of `identify` says of the errors of torques predicted with it.
struct prediction_spread {
    Eigen::MatrixXd covariance;  ///< [b x b] of the parameters
    std::vector<double> noise;   ///< [n] deviation of the rows they were identified from; of one period where averaged
};

/// Values of the base parameters, from a result of `identify --json`, or a YAML or JSON map of names to values.
struct identified_parameters {
    Eigen::VectorXd chi;                           ///< [b], in the order of the robot's model
    std::optional<filter_choice> filter = {};      ///< the filtering they were identified with, if the file says
    std::optional<prediction_spread> spread = {};  ///< if the file says, and no parameter is each log's own
};

/// Throws input_error where the file cannot be read, a base parameter of the robot is missing, or one is named that the
/// robot does not have.
identified_parameters read_parameters(const std::string& file, const loaded_robot& robot);

/// Standard parameters: those of a result of `identify --method cwls`, else the values of the file as they stand.
std::map<std::string, double> read_standard_parameters(const std::string& file);

}  // namespace idim::cli
