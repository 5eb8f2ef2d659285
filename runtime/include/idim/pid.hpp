#pragma once

#include "idim/control_law.hpp"

namespace idim {

/// PID of every joint: v = kp e + ki sum(e T) + kd (qdr - qd), e = qr - q. The sum takes in the present error and
/// stands still while the command is limited.
class pid : public control_law {
  public:
    Eigen::VectorXd kp, ki, kd;         ///< [n] drive command per rad or m, per rad*s or m*s, per rad/s or m/s
    Eigen::VectorXd natural_frequency;  ///< [n] rad/s; empty where kp and kd are given
    Eigen::VectorXd damping;            ///< [n]

    std::unique_ptr<control_law> clone() const override { return std::make_unique<pid>(*this); }
    /// kp = wn^2 J / g, kd = 2 zeta wn J / g.
    void tune(const Eigen::VectorXd& inertia) override;

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;
    void limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) override;
    void forget() override;

  private:
    Eigen::VectorXd sum_, step_;  ///< [n] integral of the error, and what this sample added
};

}  // namespace idim
