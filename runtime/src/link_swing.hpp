#pragma once

#include <Eigen/Core>
#include <vector>

namespace idim {

/// A transmission that is not rigid, on the joint's side: torque K (motor - link) + D (motor - link)'.
struct soft_transmission {
    int joint;
    double stiffness;      ///< K > 0 [N*m/rad or N/m]
    double damping = 0.0;  ///< D [N*m*s/rad or N*s/m]
};

Eigen::VectorXd stiffnesses(const std::vector<soft_transmission>& soft);
Eigen::VectorXd dampings(const std::vector<soft_transmission>& soft);

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

/// Twists of the transmissions at one instant, and their rates, [s] each.
struct twist_state {
    Eigen::VectorXd angle;
    Eigen::VectorXd rate;
};

/// Damping below a hundredth of the critical one is taken for that: the noise of measured motion would pile up.
inline constexpr double least_damping_ratio = 0.01;

/// Solves M twist'' + D twist' + K twist = forcing from sample to sample, exactly for inertias that stay as between the
/// two and a forcing that goes straight from one to the next: modes much faster than the sampling follow at rest
/// instead of upsetting it. The twist is zero throughout where an inertia is not positive definite: no link swings so.
twist_motion swing(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate,
                   const twist_state& start);

}  // namespace idim
