#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "undeclared/missing_effect.hpp"

namespace idim::undeclared {

/// State of the drives at one instant, of all joints.
struct plant_signals {
    double t = 0.0;
    Eigen::VectorXd q, qd, qdd;   ///< [rad or m and derivatives]
    Eigen::VectorXd tau_rigid;    ///< of the rigid links alone
    Eigen::VectorXd slip;         ///< sign of the motion, between -1 and 1 where a joint sticks
    Eigen::VectorXd temperature;  ///< [degC]
};

using signal_function = std::function<double(const plant_signals&)>;

/// A torque that the drive of a joint has to bring in addition.
struct torque_term {
    int joint;
    signal_function torque;
};

/// Dry friction along the sum of the velocities of `joints`.
struct dry_term {
    std::vector<int> joints;
    signal_function magnitude;
};

/// A transmission between motor and link: a spring and damper beyond a play of `gap` in all.
struct transmission {
    int joint;
    double stiffness, damping, gap;
};

/// A bristle in the place of the joint's dry friction [Dahl 1968], with damping as in [Canudas de Wit 1995] if any.
struct bristle {
    int joint;
    double stretch;  ///< deflection at which friction is full [rad or m]
    double damping;  ///< times the stiffness [s]
};

struct carried_load {
    int link;
    solid body;
    double from, until;  ///< [s]
};

/// An entry of the inertia matrix and the one across its diagonal.
struct coupled_inertia {
    int joint, other;
    double inertia;
};

/// What the effects change in the plant and in its measurement.
struct plant_changes {
    std::vector<torque_term> torques;
    std::vector<dry_term> dry;
    std::vector<transmission> transmissions;
    std::vector<bristle> bristles;
    std::vector<carried_load> loads;
    std::vector<coupled_inertia> inertias;
    std::optional<Eigen::Vector3d> gravity;
    Eigen::VectorXd delay;  ///< of the measured torque, joint by joint [s]
    Eigen::VectorXd gain;   ///< of the measured torque: 1 where it is right
};

plant_changes changes_of(const std::vector<missing_effect>& effects, const arm& robot);

}  // namespace idim::undeclared
