#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "idim/model_interface.h"

namespace idim {

/// Cascade PD of every joint: v = kp kv (qr - q) - kv qd, tau = g v [IV 40-41].
struct pd_cascade {
    double rate = 0.0;           ///< sampling rate of the controller [Hz]; its output is held in between
    Eigen::VectorXd kp;          ///< [n] 1/s
    Eigen::VectorXd kv;          ///< [n] drive command per unit of velocity
    Eigen::VectorXd drive_gain;  ///< [n] g, N*m or N per unit of drive command
    Eigen::VectorXd saturation;  ///< [n] largest drive command; empty where there is none

    /// Torques for measured q, qd and reference qr, all [n].
    Eigen::VectorXd torque(const Eigen::VectorXd& qr, const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const;
};

/// J_j = largest M_jj(q) over the joint space [IV 38], by sampling: revolute joints over a turn, prismatic ones over
/// -1..1 m.
Eigen::VectorXd largest_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi);

/// Gains from the bandwidth: kp = wn / (2 zeta), kv = 2 zeta wn J / g [IV 44-45]. wn [rad/s] and zeta are [n].
pd_cascade tune_pd_cascade(double rate, const Eigen::VectorXd& wn, const Eigen::VectorXd& zeta,
                           const Eigen::VectorXd& inertia, const Eigen::VectorXd& drive_gain);

}  // namespace idim
