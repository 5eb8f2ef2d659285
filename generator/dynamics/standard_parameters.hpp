#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/effect_description.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// Inertial parameters of a link at the origin of its frame, in its frame ([IV 3]); `effect` for everything else.
enum class parameter_kind { XX, XY, XZ, YY, YZ, ZZ, MX, MY, MZ, M, effect };

/// One standard parameter: the torque is linear in all of them.
struct standard_parameter {
    std::string name;  ///< such as "ZZ1", "Fv2", "Fvc6_5"
    parameter_kind kind = parameter_kind::effect;
    int joint = 0;  ///< index of the link or of the joint the effect acts on
    std::string unit;
    std::optional<double> min;
    /// Effects only: torque per unit of the parameter at each coordinate it acts on, in the tree's q, qd, qdd and the
    /// symbols t and temp.
    std::vector<std::pair<int, GiNaC::ex>> columns = {};

    /// Torque per unit of the parameter at a coordinate, zero where it does not act.
    GiNaC::ex column_at(int coordinate) const;
};

/// Everything a torque depends on linearly, link by link: ten inertial parameters unless the link is massless, then the
/// effects in declared order.
struct standard_parameters {
    std::vector<standard_parameter> all;
    GiNaC::symbol time{"t"};
    std::vector<GiNaC::symbol> temperature;  ///< per coordinate
    bool uses_time = false;
    bool uses_temperature = false;

    /// Index of an inertial parameter of a link; all.size() if the link is massless.
    std::size_t index(int link, parameter_kind kind) const;
};

/// Lists the parameters of a tree with effects; `descriptions` holds one description per entry of `uses`. An effect
/// acts on the coordinate of its joint; at a joint without a coordinate of its own it takes the joint's variable and
/// acts on all coordinates that move it. Throws input_error where a torque is not linear in its coefficients, uses a
/// signal that it cannot have, or two effects name the same coefficient at one joint.
standard_parameters list_parameters(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                    const std::vector<effect_description>& descriptions);

}  // namespace idim::generator
