#pragma once

#include <Eigen/Core>
#include <string>

#include "undeclared/joint_controller.hpp"
#include "undeclared/measurement.hpp"
#include "undeclared/plant_changes.hpp"

namespace idim::undeclared {

/// How a robot is driven and logged.
struct recording_settings {
    controller_settings controller;
    double log_rate = 1000.0;     ///< [Hz], the controller's rate or a whole part of it
    double step = 0.0005;         ///< of the plant [s]
    bool commanded = false;       ///< logs the command that begins to act at t, and not the mean torque around t
    double regularisation = 0.0;  ///< of dry friction, share of the top speed; 0: joints really stick
    noise position, torque;
    bool reference_columns = false, temperature_columns = false;
    double warm_up_time = 20.0;  ///< of the temperatures [s]
};

/// What was logged, and what only the simulator knows. Rows are samples, columns joints.
struct recording {
    Eigen::VectorXd t;
    Eigen::MatrixXd q, tau;           ///< as measured
    Eigen::MatrixXd clean_q, effect;  ///< positions without noise; torque measured beyond what the declared model says
    Eigen::MatrixXd torque_noise;     ///< what the measurement added
    Eigen::MatrixXd reference, temperature;
};

/// Closed loop along the reference. Throws std::runtime_error where the loop is not stable.
recording record(const arm& robot, const plant_changes& changes, const motion& reference, const joint_scales& scales,
                 const recording_settings& settings, const sampler& random);

/// The log as CSV, the columns that settings ask for. `without_effect` takes the effect out of the torque: the same
/// motion and noise as of a robot that the description describes.
void write_log(const std::string& file, const recording& made, const recording_settings& settings, bool without_effect);

}  // namespace idim::undeclared
