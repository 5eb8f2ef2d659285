#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "idim/log.hpp"
#include "oracles/mujoco_robot.hpp"

namespace idim::test {

/// A serial arm in MuJoCo with rotors and friction at its joints, under a sampled cascade PD [IV 40-41]; integrated by
/// code of its own, Runge-Kutta of order four.
struct mujoco_arm {
    mujoco_robot robot;
    Eigen::VectorXd rotor, viscous, coulomb;  ///< [n] Ia, Fv, Fc
    double rate = 1000.0;                     ///< of control and measurement [Hz]
    Eigen::VectorXd kp, kv;                   ///< [n] 1/s, and torque per velocity
    double position_noise = 0.0;              ///< white [rad]; fed back too
    Eigen::VectorXd torque_noise;             ///< [n] white, of the recorded torque [N*m]

    /// What a logger records along `reference` (t at `rate`, qr), starting on it at rest.
    log record(const log& reference, std::uint64_t seed) const;
};

/// Sums of eight harmonics of 0.1 Hz with random phases about `centre` [n], within `amplitude` of it [rad], eased in
/// over 3 s, at 1 kHz.
log arm_reference(const Eigen::VectorXd& centre, double amplitude, double seconds, std::uint64_t seed);

}  // namespace idim::test
