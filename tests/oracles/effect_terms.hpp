#pragma once

#include <Eigen/Core>

#include "oracles/joint_state.hpp"
#include "oracles/text_value.hpp"

namespace idim::test {

/// Torques [n] of what is no rigid link, in closed form: Ia<j> qdd_j, Fv<j> qd_j, Fc<j> sign(qd_j), off<j>, and
/// Ia<j>_<k> (qdd_j + qdd_k) at both joints. Inertial parameters in `parameters` are passed over; throws
/// std::runtime_error for any other name.
Eigen::VectorXd effect_torque(const value_table& parameters, const joint_state& state);

}  // namespace idim::test
