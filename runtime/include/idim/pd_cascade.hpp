#pragma once

#include "idim/control_law.hpp"

namespace idim {

/// Cascade PD of every joint: v = kp kv (qr - q) - kv qd, tau = g v [IV 40-41].
class pd_cascade : public control_law {
  public:
    Eigen::VectorXd kp;                 ///< [n] 1/s
    Eigen::VectorXd kv;                 ///< [n] drive command per unit of velocity
    Eigen::VectorXd natural_frequency;  ///< [n] rad/s; empty where kp and kv are given
    Eigen::VectorXd damping;            ///< [n] zeta; empty likewise

    std::unique_ptr<control_law> clone() const override { return std::make_unique<pd_cascade>(*this); }
    /// kv = 2 zeta wn J / g; kp never changes [IV 44-46].
    void tune(const Eigen::VectorXd& inertia) override;

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;
};

/// Gains from the bandwidth: kp = wn / (2 zeta), kv = 2 zeta wn J / g [IV 44-45]. wn [rad/s] and zeta are [n].
pd_cascade tune_pd_cascade(double rate, const Eigen::VectorXd& wn, const Eigen::VectorXd& zeta,
                           const Eigen::VectorXd& inertia, const Eigen::VectorXd& drive_gain);

}  // namespace idim
