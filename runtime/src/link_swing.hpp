#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "idim/filtered_samples.hpp"

namespace idim {

/// A transmission that is not rigid, on the joint's side: torque K (motor - link) + D (motor - link)'.
struct soft_transmission {
    int joint;
    double stiffness;      ///< K > 0 [N*m/rad or N/m]
    double damping = 0.0;  ///< D [N*m*s/rad or N*s/m]
};

/// What drives the links behind s soft transmissions: their torque is `forcing` - `inertia` times the acceleration of
/// the twist, the motor's position less the link's.
struct swing_dynamics {
    Eigen::MatrixXd forcing;  ///< samples x s: torque if the links accelerated as their motors do
    Eigen::MatrixXd inertia;  ///< samples x s*s: column i*s + k is M of the links, row k, column i
};

/// How far motors are ahead of their links, samples x s each.
struct twist_motion {
    Eigen::MatrixXd angle;
    Eigen::MatrixXd rate;
    Eigen::MatrixXd acceleration;
};

/// Solves M twist'' + D twist' + K twist = forcing from sample to sample, exactly for inertias that stay as between the
/// two and a forcing that goes straight from one to the next: modes much faster than the sampling follow at rest
/// instead of upsetting it. A mode is damped by a hundredth of the critical damping at least, or the noise of measured
/// motion would pile up in it. It starts as a slow motion would; the twist is zero throughout where an inertia is not
/// positive definite: no link swings so.
twist_motion swing(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate);

/// Torque of links and payloads alone along a motion of the links, samples x n; affine in their accelerations.
using links_torque = std::function<Eigen::MatrixXd(const filtered_samples&)>;

/// The motion of the links of a robot whose motors moved like this: theirs, less the twists of the soft transmissions.
/// Measured motors lead; nothing is assumed of what drove them (Spong 1987, the links' half of the equations).
filtered_samples links_behind(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                              const links_torque& torque);

}  // namespace idim
