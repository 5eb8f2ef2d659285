#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/model_interface.h"

namespace idim {

/// Motors and links that transmissions of finite stiffness K and damping D join (Spong 1987, reduced by no rotor's own
/// turning in space): a soft joint has two coordinates, its motor's and its link's, tau_j is the torque of the link
/// and what acts on the motor, and the torque of the link is K (motor - link) + D (motor - link)'. All on the joint's
/// side.
class soft_transmissions {
  public:
    soft_transmissions(const idim_model_interface& model, const Eigen::VectorXd& chi);

    /// Joints whose transmission is soft, in order.
    const std::vector<int>& joints() const { return joints_; }
    Eigen::Index count() const { return static_cast<Eigen::Index>(joints_.size()); }

    /// Where the robot is and what drives it; frames and units of the model.
    struct instant {
        const double* link;  ///< positions of the links [n]
        const Eigen::VectorXd& link_speed;
        const Eigen::VectorXd& motor;  ///< positions of the motors [n]
        const Eigen::VectorXd& motor_speed;
        const Eigen::VectorXd& tau;  ///< [n]
        double t;
        const Eigen::VectorXd& signals;  ///< `temp` of the model; its motors are filled in here
    };

    /// Accelerations of the links [n], then of the motors of soft joints [count()]. False where they do not follow: no
    /// inertia between a torque and its joint.
    bool accelerations(const instant& at, double* acceleration) const;

    /// Positions of the links at rest behind these positions of the motors [n].
    Eigen::VectorXd links_at_rest(const Eigen::VectorXd& motor, double t) const;

    /// Upper bound of the rates at which links and motors swing against each other [rad/s]; 0 where none is soft,
    /// infinite for a soft joint whose motor or link has no inertia.
    double fastest_swing(const Eigen::VectorXd& q) const;

  private:
    Eigen::VectorXd residual(const instant& at, const Eigen::VectorXd& acceleration) const;
    Eigen::MatrixXd slope(const instant& at, const Eigen::VectorXd& at_rest) const;

    const idim_model_interface& model_;
    const Eigen::VectorXd& chi_;
    std::vector<int> joints_;
};

}  // namespace idim
