#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "idim/log.hpp"

namespace idim::test {

/// The 2R SCARA of [IV section 4] under its cascade controller, written down from the printed equations [IV 40-45,
/// 52-53] and integrated by code of its own: nothing of it is shared with the generated models or the simulation of the
/// library.
struct scara_loop {
    /// ZZ1R Fv1 Fc1 ZZ2R LMX2 LMY2 Fv2 Fc2 [IV table 1].
    Eigen::VectorXd chi = (Eigen::VectorXd(8) << 3.44, 0.03, 0.82, 0.062, 0.121, 0.007, 0.013, 0.137).finished();
    double rate = 200.0;                              ///< of control and measurement [Hz]
    Eigen::Vector2d natural_frequency = {1.0, 10.0};  ///< [rad/s], damping 1
    Eigen::Vector2d position_noise = {0.0, 0.0};      ///< white, of the measured positions, fed back too [rad]
    Eigen::Vector2d torque_noise = {0.0, 0.0};        ///< white, of the recorded torque [N*m]
    /// Torque that acts on the joints and that no model has: deviation [N*m] of a first-order process with a corner at
    /// `disturbance_corner` [Hz].
    Eigen::Vector2d disturbance = {0.0, 0.0};
    double disturbance_corner = 2.0;

    /// What a logger records of the motion along `reference` (t at `rate`, qr), starting on it at rest.
    log record(const log& reference, std::uint64_t seed) const;
};

/// Sums of sines within the bandwidth of the two joints, `seconds` long at 200 Hz, eased in over 4 s.
log scara_reference(double seconds);

}  // namespace idim::test
