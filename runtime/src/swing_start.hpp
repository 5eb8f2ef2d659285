#pragma once

#include <Eigen/Core>
#include <vector>

#include "link_swing.hpp"

namespace idim {

/// Twist and its rate as a motion much slower than the swing begins it: K twist = F - D F'/K - M F''/K, with the
/// derivatives of a cubic through samples a quarter of the slowest swing apart. What is not so swings freely at first.
/// Zero for a motion of fewer than four samples, or without inertia.
twist_state slow_start(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate);

/// Samples at the beginning of a motion in which a link that swings freely is still seen to: until it has decayed to a
/// twentieth, sixteen swings at most.
Eigen::Index free_samples(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate);

/// How much more the transmissions are twisted at the first sample than some model of them has it, by least squares:
/// links that swing freely from that difference take `lacking` [samples x s], the measured torque of the motors less
/// that of the model. A swing too fast for the sampling tells nothing: zero.
twist_state free_start(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate,
                       const Eigen::MatrixXd& lacking);

twist_state operator+(const twist_state& a, const twist_state& b);

}  // namespace idim
