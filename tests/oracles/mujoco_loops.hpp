#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "oracles/joint_state.hpp"
#include "oracles/mdh_row.hpp"
#include "oracles/rigid_link.hpp"

namespace idim::test {

/// Links with joints that form a tree, in numbers: a modified Denavit-Hartenberg row each.
struct tree_row {
    int antecedent = -1;
    mdh_row row;
};

/// A loop as two points that a revolute joint holds together. `sense` is the sign of the area of the corners first
/// passive joint, second one, cut, about the axis of the first; 0: a parallelogram, its fourth corner at a joint.
struct held_points {
    std::array<int, 2> links;  ///< -1: the base
    std::array<Eigen::Vector3d, 2> points;
    std::array<int, 2> passive;
    int sense = 0;
    int fourth = -1;
};

/// A robot with closed loops: its tree in MuJoCo, cut open. Passive joints are found by Newton's method on the distance
/// of the points, rates by MuJoCo's Jacobians, and what changes of these do along a motion by differences of order
/// four.
class mujoco_loops {
  public:
    mujoco_loops(const std::array<double, 3>& gravity, const std::vector<tree_row>& rows,
                 const std::vector<rigid_link>& links, const std::vector<held_points>& loops);

    Eigen::Index dof() const { return static_cast<Eigen::Index>(active_.size()); }
    /// Positions of all joints; empty where the loops do not close. Starts from `near` if it is not empty.
    Eigen::VectorXd closed(const Eigen::VectorXd& active, const Eigen::VectorXd& near = {}) const;
    /// How far from a singular position: smallest singular value of the Jacobian of the passive joints [m].
    double margin(const Eigen::VectorXd& all) const;
    /// Velocities of all joints per unit velocity of the active ones [joints x active].
    Eigen::MatrixXd rates(const Eigen::VectorXd& all) const;
    /// Motion of all joints.
    joint_state motion(const joint_state& active) const;
    /// G' times the torques of the tree.
    Eigen::VectorXd inverse_dynamics(const joint_state& active) const;
    /// Kinetic and potential energy [J].
    double energy(const Eigen::VectorXd& active, const Eigen::VectorXd& velocity) const;

  private:
    void place(const Eigen::VectorXd& all) const;
    Eigen::Vector3d point(const held_points& loop, std::size_t side) const;
    Eigen::VectorXd gaps() const;
    Eigen::MatrixXd jacobian() const;  ///< of gaps [3 loops x joints]
    bool has_sense() const;

    std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
    std::unique_ptr<mjData, void (*)(mjData*)> data_;
    std::vector<held_points> loops_;
    std::vector<int> address_;  ///< of each joint in qpos and qvel
    std::vector<Eigen::Index> active_, passive_;
};

/// The robot of a description with the given links; `fourth`: of each parallelogram, in the order of the loops.
mujoco_loops mujoco_loops_of(const generator::robot_description& robot, const std::vector<rigid_link>& links,
                             const std::vector<int>& fourth = {});

}  // namespace idim::test
