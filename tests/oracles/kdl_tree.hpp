#pragma once

#include <Eigen/Core>
#include <kdl/tree.hpp>
#include <string>
#include <vector>

#include "oracles/joint_state.hpp"

namespace idim::test {

/// The robot of a URDF text in Orocos KDL, segment by segment from what urdfdom reads: joints stay where the URDF has
/// them, no other frames are laid. Gravity is 9.81 m/s^2 along -z of the root link.
class kdl_tree {
  public:
    /// States and torques are in the order of `joints`: every joint that moves, by name.
    kdl_tree(const std::string& urdf, std::vector<std::string> joints);

    /// Recursive Newton-Euler over the tree (TreeIdSolver_RNE).
    Eigen::VectorXd inverse_dynamics(const joint_state& state) const;
    /// Torques of unit accelerations, one joint at a time, without gravity and velocity.
    Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const;

  private:
    Eigen::VectorXd torque(const joint_state& state, double gravity) const;

    KDL::Tree tree_;
    std::vector<Eigen::Index> number_;  ///< in KDL, of each joint
};

}  // namespace idim::test
