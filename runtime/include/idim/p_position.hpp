#pragma once

#include "idim/control_law.hpp"

namespace idim {

/// Proportional position loop around a PI velocity loop: w = kp (qr - q) + kf qdr, v = kv (w - qd) + ki sum((w - qd)
/// T). The sum stands still while the command is limited.
class p_position : public control_law {
  public:
    Eigen::VectorXd kp;                 ///< [n] 1/s
    Eigen::VectorXd kv;                 ///< [n] drive command per unit of velocity
    Eigen::VectorXd ki;                 ///< [n] drive command per unit of position
    Eigen::VectorXd kf;                 ///< [n] share of the reference's velocity fed forward, 0..1
    Eigen::VectorXd natural_frequency;  ///< [n] rad/s; empty where kp and kv are given
    Eigen::VectorXd damping;            ///< [n]

    std::unique_ptr<control_law> clone() const override { return std::make_unique<p_position>(*this); }
    /// kv = 2 zeta wn J / g.
    void tune(const Eigen::VectorXd& inertia) override;

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;
    void limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) override;
    void forget() override;

  private:
    Eigen::VectorXd sum_, step_;
};

}  // namespace idim
