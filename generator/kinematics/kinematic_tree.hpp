#pragma once

#include <ginac/ginac.h>

#include <array>
#include <string>
#include <vector>

#include "description/robot_description.hpp"
#include "kinematics/expression_parser.hpp"

namespace idim::generator {

/// Cosine and sine of an angle as they enter the transforms.
struct angle_pair {
    GiNaC::ex cos = 1;
    GiNaC::ex sin = 0;
};

/// The angle after further quarter turns, 0 to 3.
angle_pair turned(const angle_pair& angle, int quarters);

/// A symbol whose value is known: a named length, or the cosine or sine of a constant angle. Formulas print its text,
/// code folds its value.
struct kinematic_constant {
    GiNaC::symbol symbol;
    std::string text;  ///< as printed in regroupings: "L", "cos(a)"; a number if the description gives a bare number
    bool is_named = false;  ///< has a name of its own, so that a formula should show it
    GiNaC::numeric value;   ///< exact rational
    int angle = -1;         ///< cosine and sine of the same angle share this number; -1 for lengths
    bool is_sine = false;
};

/// Velocity of a joint per unit velocity of a coordinate.
struct joint_rate {
    int coordinate = 0;
    GiNaC::ex factor = 1;  ///< without coordinates, or a symbol of kinematic_tree::from_positions
};

/// A symbol that stands for `body`, made of coordinates, constants and symbols defined before.
struct kinematic_definition {
    GiNaC::symbol symbol;
    GiNaC::ex body;
};

/// One joint with its transform; the frame of the link in that of its antecedent is
/// Rot(z,gamma) Trans(z,b) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r) (Khalil and Kleinfinger 1986).
struct kinematic_joint {
    std::string name;
    joint_type type = joint_type::revolute;
    int antecedent = -1;
    bool massless = false;  ///< its link has no inertial parameters
    int coordinate = -1;    ///< the joint's own, -1 if it is fixed or moves with other joints
    std::string label;      ///< suffix of every symbol of this link: number of its own coordinate ("2"), or "_name"
    angle_pair gamma, alpha;
    angle_pair theta;     ///< for a revolute joint in terms of the leaves cos(angle), sin(angle)
    GiNaC::ex angle = 0;  ///< revolute: the argument of these leaves, theta less what is a multiple of pi/2
    GiNaC::ex b = 0, d = 0, r = 0;
    std::vector<joint_rate> rates;  ///< of theta or r, by ascending coordinate; empty if fixed
    GiNaC::ex variable = 0;         ///< theta or r of a joint that moves
    bool passive = false;           ///< a loop determines its variable
    GiNaC::ex drift = 0;            ///< passive: acceleration while no coordinate accelerates

    /// Origin of the link frame in the frame of the antecedent [m].
    std::array<GiNaC::ex, 3> position() const;
};

/// Joints in an order where antecedents come first, with every entry symbolic.
struct kinematic_tree {
    std::string robot;
    std::vector<kinematic_joint> joints;
    std::vector<int> driven;  ///< joint index of each coordinate
    std::vector<GiNaC::symbol> q, qd, qdd;
    std::vector<kinematic_constant> constants;
    named_values constant_names;  ///< what an effect's expression may name
    std::array<GiNaC::ex, 3> gravity = {0, 0, 0};
    /// What closed loops make of the coordinates: sines, cosines and rates of passive joints, and from velocities too
    /// their drifts. Models define these symbols before they use them.
    std::vector<kinematic_definition> from_positions, from_velocities;
    /// Of each loop that is no parallelogram the squared sine of the angle between the sides that meet at the cut: the
    /// loop closes where it is positive.
    std::vector<GiNaC::ex> closures;

    int dof() const { return static_cast<int>(driven.size()); }
    /// Joints from `joint` to the base, `joint` first.
    std::vector<int> path_to_base(int joint) const;
};

/// Reads the expressions of a description. Throws input_error where theta of a revolute or r of a prismatic joint is
/// not a linear function of q and the q_<joint> of joints that have a coordinate, or where another entry depends on
/// these, and for loops that do not close (see close_loop).
kinematic_tree build_kinematic_tree(const robot_description& robot);

/// Exact values of the tree's constants.
GiNaC::exmap values_of_constants(const kinematic_tree& tree);
/// What an expression in constants is worth.
double number_of(const GiNaC::ex& constant, const GiNaC::exmap& values);

}  // namespace idim::generator
