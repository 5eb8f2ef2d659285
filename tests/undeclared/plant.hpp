#pragma once

#include <Eigen/Core>
#include <vector>

#include "undeclared/plant_changes.hpp"
#include "undeclared/rigid_body_engine.hpp"

namespace idim::undeclared {

/// The robot with everything that acts on it, in steps of fixed length. Positions and torques belong to whole steps,
/// velocities to the middle between two (leapfrog). Dry friction is a constraint that is solved for together with the
/// velocities at the end of the step, by Gauss-Seidel on the impulses [Moreau 1988, Jourdan, Alart, Jean 1998]: with
/// `regularisation` 0 joints really stick, otherwise friction rises in proportion up to that share of the top speed.
class plant {
  public:
    plant(const arm& robot, const plant_changes& changes, double step, const Eigen::VectorXd& regularisation);

    /// One step under these drive torques, held over the step [N m or N].
    void advance(const Eigen::VectorXd& tau, const Eigen::VectorXd& temperature);

    double time() const { return signals_.t; }
    const Eigen::VectorXd& q() const { return signals_.q; }    ///< of the drives, at the beginning of the next step
    const Eigen::VectorXd& qd() const { return signals_.qd; }  ///< of the last step, at its beginning
    const Eigen::VectorXd& qdd() const { return signals_.qdd; }
    /// What the declared model says of the last step: rigid links, rotors, viscous and Coulomb friction, offsets.
    const Eigen::VectorXd& declared_torque() const { return declared_; }

  private:
    struct dry_row {
        std::vector<int> joints;
        double magnitude = 0.0, impulse = 0.0;
    };

    void carry_loads();
    void collect_forces(const Eigen::VectorXd& tau);
    void set_magnitudes();
    void solve_friction();
    void advance_bristles();
    void declare(const joint_matrix& links_M);
    bool is_nominal() const;

    arm robot_;
    plant_changes changes_;
    double step_;
    Eigen::VectorXd regularisation_;
    rigid_body_engine engine_, nominal_;
    std::vector<bool> loaded_;
    plant_signals signals_;
    Eigen::VectorXd link_q_, link_velocity_, drive_velocity_;  ///< velocities half a step before
    Eigen::VectorXd link_force_, drive_force_, N_, declared_, rotors_;
    joint_matrix M_, compliance_;  ///< inverse of the inertia matrix, rotors of stiff joints included
    std::vector<dry_row> rows_;    ///< one a joint, then those of changes_ that take several
    std::vector<double> deflection_;
    std::vector<int> transmission_of_, bristle_of_;  ///< by joint, -1: none
};

}  // namespace idim::undeclared
