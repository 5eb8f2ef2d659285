#pragma once

#include <string>
#include <vector>

#include "description/effect_description.hpp"
#include "graph/expression_graph.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// The functions of one effect file, for any joint: leaves are the signals of the joint (q[0], qd[0], qdd[0], tau[0]:
/// the rigid links' torque, t, temp[0]) and of the joint that drives it (q[1] ...), the shapes (chi[0..], behind them
/// the time step), and the states (standard[0..]).
struct effect_functions {
    std::string symbol;  ///< name in generated code
    effect_description description;
    std::vector<linear_coefficient> linear;
    std::vector<shape_coefficient> shape;  ///< those that this form of the torque uses
    expression_graph columns;              ///< X[c]: torque per unit of linear coefficient c
    expression_graph start;                ///< next[s]: states at the first sample
    expression_graph next;                 ///< next[s]: states at the following sample
    bool uses_rigid_torque = false;
    bool uses_temperature = false;
    bool uses_time = false;
};

/// Functions of an effect; two forms where it has a torque without temperature, one otherwise. Names of the robot's
/// constants stand for their values. Throws input_error where the torque is not linear in its coefficients.
std::vector<effect_functions> functions_of(const effect_description& effect, const kinematic_tree& tree);

}  // namespace idim::generator
