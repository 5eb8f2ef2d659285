#pragma once

#include <vector>

#include "effect_candidate.hpp"
#include "idim/effect_trace.hpp"
#include "idim/model_interface.h"

namespace idim {

/// The torque of joint j measured late by Td >= 0: the column is the secant (tau(t - at) - tau(t)) / at of the present
/// model's torque, its coefficient Td. A delay below the sampling period of the log tells of the sampling, not of the
/// robot.
candidate_pointer delay_candidate(int joint, double at, double period);

/// All joints' torque late by the same time, a part of a sample: a drive that holds its command for a period, a logger
/// that reads torque and position one after the other. A nuisance, no effect.
candidate_pointer alignment_candidate(int joints, double at);

/// The torque of joint j scaled by 1 + Ke: the column is the present model's torque.
candidate_pointer gain_candidate(int joint);

/// A transmission of stiffness K and damping D at joint j: the link swings behind its motor, driven by the torque that
/// it would have if it moved as the motor does. The only column, of coefficient one, is what that changes at all
/// joints; the twist swings as if gravity and velocities were those of the motor's motion. Where the rotor is part of
/// the link in the present model, which link and rotor that move alike do not tell, its inertia is a third shape: a
/// soft transmission makes it a parameter of its own.
candidate_pointer elasticity_candidate(const idim_model_interface& model, int joint, bool rotor_is_lumped);

/// Gravity turned about each axis that it is not along: the columns are the changes of the gravity torques per radian,
/// from the models with gravity turned. Where the present parameters do not tell what gravity then shows (first moments
/// about an upright axis), columns of these moments stand beside them, to be fitted and not reported. Null where there
/// is no such axis.
candidate_pointer tilt_candidate(const idim_model_interface& model, const std::vector<turned_model>& turned,
                                 const Eigen::VectorXd& chi);

/// Ten inertial parameters at the link of joint j from t0 to t1 of a log.
candidate_pointer payload_candidate(const idim_model_interface& model, int joint);

}  // namespace idim
