#pragma once

#include <Eigen/Core>

#include "idim/log.hpp"

namespace idim::test {

/// The EMPS axis, tau = M qdd + Fv qd + Fc sign(qd) + offset, under its recorded control law [Janot, Gautier and Brunot
/// 2019]: u = kv (kp (qr - q) - d), d the difference of the position averaged over two samples, 1 kHz, +-10 V. Written
/// down and integrated by code of its own.
struct emps_loop {
    double kp = 160.18;               ///< [1/s]
    double kv = 243.45;               ///< [V/(m/s)]
    double gain = 35.15065188248547;  ///< [N/V]
    double saturation = 10.0;         ///< [V]

    /// Motion under M, Fv, Fc, offset along the reference of a record, kv multiplied by `kv_scale`; starts on the
    /// reference, at rest. tau: mean of the forces held before and after a sample.
    log motion(const Eigen::VectorXd& chi, const log& recorded, double kv_scale = 1.0) const;
};

}  // namespace idim::test
