#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"
#include "link_swing.hpp"

namespace idim {

/// Torque of links and payloads alone along a motion of the links, samples x n; affine in their accelerations.
using links_torque = std::function<Eigen::MatrixXd(const filtered_samples& links)>;
/// Measured torques less those of the model [samples x n] at the beginning of a motion, given the motions of the motors
/// and of the links there.
using lacking_torque = std::function<Eigen::MatrixXd(const filtered_samples& motors, const filtered_samples& links)>;

/// The transmissions that a model declares soft.
std::vector<soft_transmission> transmissions_of(const idim_model_interface& model);
/// Torque of the links of a model along a motion of theirs, samples x n.
Eigen::MatrixXd rigid_torques(const idim_model_interface& model, const filtered_samples& links,
                              const Eigen::VectorXd& chi);
/// What drives links that move like this behind motors that move like that.
swing_dynamics dynamics_of(const filtered_samples& link, const filtered_samples& motor,
                           const std::vector<soft_transmission>& soft, const links_torque& torque);

/// The motion of the links of a robot whose motors moved like this: theirs, less the twists of the soft transmissions.
/// Measured motors lead; nothing is assumed of what drove them (Spong 1987, the links' half of the equations). How the
/// links swing at first, which no motion of the motors tells, is what `lacking` asks for (free_start); without it, they
/// start as a slow motion would.
filtered_samples links_behind(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                              const links_torque& torque, const lacking_torque& lacking = {});

}  // namespace idim
