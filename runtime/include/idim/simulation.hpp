#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "idim/log.hpp"
#include "idim/pd_cascade.hpp"

namespace idim {

/// Errors of the measurement, Gaussian, the same with every standard library. An empty vector is zero.
struct measurement_noise {
    Eigen::VectorXd position;  ///< [n] standard deviation [rad or m]; seen by the controller too
    Eigen::VectorXd torque;    ///< [n] standard deviation [N*m or N]; of the log alone
    std::uint64_t seed = 1;
    Eigen::VectorXd velocity = {};    ///< [n] standard deviation of the speed the controller sees [rad/s or m/s]
    Eigen::VectorXd resolution = {};  ///< [n] step of the encoder [rad or m]: noisy positions are rounded to it
    /// [s] of an AR(1) process: samples T apart correlate by exp(-T/time); the deviation stays as given. 0: white.
    double position_correlation = 0.0;
    double torque_correlation = 0.0;
};

enum class integrator { rk4, dopri5 };

/// What becomes of the jump of friction where a joint's speed changes its sign.
/// located: the time of the change is found; the joint then rests for as long as its friction can hold it, as a
/// constraint. Jumps that hang on a sum of speeds (joint_coupling) are not located but taken as `sign`.
/// regularised: between -band and band the torque is linear in the speed.
/// sign: the model as it is; a joint that should rest chatters by a step's worth of speed.
enum class friction_handling { located, regularised, sign };

/// How the continuous robot is integrated between two samples of the controller (Boost.Odeint).
struct integration_options {
    integrator method = integrator::rk4;
    /// of rk4 in a sampling period; 0: as many as it takes to make them 1 ms or shorter, and a tenth of a radian of
    /// what swings behind soft transmissions
    int substeps = 0;
    double tolerance = 1e-9;  ///< of dopri5, absolute and relative, for every position and speed
    friction_handling friction = friction_handling::located;
    double band = 1e-3;                ///< [rad/s or m/s] of regularised friction
    bool rigid_transmissions = false;  ///< joint_stiffness is not simulated: links move with their motors
};

/// Why a simulation ended early.
struct simulation_failure {
    double time = 0.0;  ///< [s]
    int joint = 0;      ///< 0..n-1
    std::string message;
};

/// A simulated motion: what a logger would have recorded, and what was true. After a failure both hold the samples up
/// to it, all finite.
struct simulated_motion {
    log measured;  ///< t, q, tau, qr at the controller's rate
    log truth;     ///< t, q, qd, qdd, tau without noise
    std::optional<simulation_failure> failure = {};
};

/// One closed loop. Model, law and reference outlive the call; the law is cloned.
struct simulated_loop_setup {
    const idim_model_interface& model;
    const Eigen::VectorXd& chi;  ///< [b]
    const control_law& law;
    const log& reference;          ///< its qr, interpolated linearly; qd and qdd if it has them, else differences
    measurement_noise noise = {};  ///< none: a simulation for instruments
    integration_options integration = {};
    Eigen::VectorXd start_position = {};  ///< [n]; empty: qr at the start
    Eigen::VectorXd start_velocity = {};  ///< [n]; empty: at rest
};

/// Closed loop of the direct dynamic model and a sampled control law: the drive holds its torque for one period while
/// the robot moves on. The logged torque is the mean of the torques held before and after the sample, as a filtered
/// current measurement gives: the command alone would lead the motion by half a period; a joint's torque_delay is
/// added. Behind a soft transmission the link swings against its motor; measured, controlled and rubbed is the motor,
/// and the log's motion is the motors', as the truth's is. An inertia matrix that is not positive definite, or a motion
/// that diverges, ends the simulation with a failure that names time and joint.
simulated_motion simulate(const simulated_loop_setup& setup);

/// The same from rest at the reference; throws data_error with the failure's message. `substeps` as in
/// integration_options.
simulated_motion simulate(const idim_model_interface& model, const Eigen::VectorXd& chi, const control_law& law,
                          const log& reference, const measurement_noise& noise, int substeps = 0);

/// Speed of the reference at its start [n], by a difference over `period`: where the simulations of [IV 3.4] begin.
Eigen::VectorXd reference_velocity(const log& reference, double period);

}  // namespace idim
