#pragma once

#include <Eigen/Core>
#include <kdl/chain.hpp>
#include <vector>

#include "oracles/joint_state.hpp"
#include "oracles/mdh_row.hpp"
#include "oracles/rigid_link.hpp"

namespace idim::test {

/// The rigid links of a robot in Orocos KDL: another implementation of another formulation (spatial vectors, 6x6
/// inertias).
class kdl_robot {
  public:
    kdl_robot(const mdh_table& table, const std::vector<rigid_link>& links);

    Eigen::Index dof() const { return static_cast<Eigen::Index>(chain_.getNrOfJoints()); }
    /// Recursive Newton-Euler (ChainIdSolver_RNE).
    Eigen::VectorXd inverse_dynamics(const joint_state& state) const;
    /// ChainDynParam.
    Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const;
    Eigen::VectorXd gravity(const Eigen::VectorXd& q) const;
    /// Potential energy [J], zero at the origin of the base.
    double potential_energy(const Eigen::VectorXd& q) const;
    const KDL::Chain& chain() const { return chain_; }

  private:
    KDL::Chain chain_;
    KDL::Vector gravity_;
};

/// W_st [n x 10 n]: torques of the parameters XX1 XY1 XZ1 YY1 YZ1 ZZ1 MX1 MY1 MZ1 M1 XX2 .., each alone at one unit.
Eigen::MatrixXd kdl_regressor(const mdh_table& table, const joint_state& state);

}  // namespace idim::test
