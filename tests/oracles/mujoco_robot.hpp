#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "oracles/joint_state.hpp"

namespace idim::test {

/// The robot of a URDF text in MuJoCo, which reads URDF by code of its own. Constraints, limits and passive forces are
/// switched off; gravity is 9.81 m/s^2 along -z of the root link.
class mujoco_robot {
  public:
    /// States and torques are in the order of `joints`: every joint that moves, by MuJoCo's name.
    mujoco_robot(const std::string& urdf, const std::vector<std::string>& joints);

    Eigen::VectorXd inverse_dynamics(const joint_state& state) const;
    Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const;
    /// Accelerations under torques; `rotor` [n] is added to the diagonal of the inertia matrix.
    Eigen::VectorXd forward_dynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
                                     const Eigen::VectorXd& rotor) const;

  private:
    void set(const joint_state& state) const;

    std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
    std::unique_ptr<mjData, void (*)(mjData*)> data_;
    std::vector<int> position_, velocity_;  ///< place of each joint in qpos, and in qvel
};

}  // namespace idim::test
