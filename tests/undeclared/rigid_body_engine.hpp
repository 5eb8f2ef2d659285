#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>

#include "undeclared/arm.hpp"

namespace idim::undeclared {

using joint_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The rigid links of an arm in MuJoCo, which knows nothing of idim: its own spatial algebra, its own frames. Rotors,
/// friction and whatever else acts at a joint are not in it.
class rigid_body_engine {
  public:
    explicit rigid_body_engine(const arm& robot);

    int dof() const { return model_->nv; }
    void set_gravity(const Eigen::Vector3d& gravity);
    void set_link(int j, const solid& body);  ///< another body in the place of link j

    /// Torques that the motion (q, qd, qdd) takes, gravity included [N m or N].
    void inverse_dynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                          Eigen::VectorXd& tau);
    /// Inertia matrix M and the torques N that stay at qdd = 0.
    void equations_of_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, joint_matrix& M, Eigen::VectorXd& N);

  private:
    void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

    std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
    std::unique_ptr<mjData, void (*)(mjData*)> data_;
};

}  // namespace idim::undeclared
