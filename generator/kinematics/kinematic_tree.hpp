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

/// One joint with its transform; the frame of the link in that of its antecedent is
/// Rot(z,gamma) Trans(z,b) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r) (Khalil and Kleinfinger 1986).
struct kinematic_joint {
    std::string name;
    joint_type type = joint_type::revolute;
    int antecedent = -1;
    int coordinate = -1;  ///< index among the driven joints, -1 if fixed
    std::string label;    ///< suffix of every symbol of this link: number of the coordinate ("2"), or "_name" if fixed
    angle_pair gamma, alpha;
    angle_pair theta;     ///< for a revolute joint in terms of the leaves cos(angle), sin(angle)
    GiNaC::ex angle = 0;  ///< revolute: the argument of these leaves, rate*q plus what is not a multiple of pi/2
    GiNaC::ex b = 0, d = 0, r = 0;
    GiNaC::ex rate = 1;  ///< d(theta)/dq or d(r)/dq

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

    int dof() const { return static_cast<int>(driven.size()); }
    /// Joints from `joint` to the base, `joint` first.
    std::vector<int> path_to_base(int joint) const;
};

/// Reads the expressions of a description. Throws input_error where theta of a revolute or r of a prismatic joint is
/// not a constant times q plus a constant, or where another entry depends on q.
kinematic_tree build_kinematic_tree(const robot_description& robot);

}  // namespace idim::generator
