#pragma once

#include <array>
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
    /// symbols of standard_parameters.
    std::vector<std::pair<int, GiNaC::ex>> columns = {};
    /// Of a payload: into standard_parameters::gates. It adds to the inertial parameter of its kind while the load is
    /// on.
    int gate = -1;
    bool per_log = false;  ///< every log has a value of its own

    bool is_of_link() const { return kind != parameter_kind::effect && gate < 0; }
    /// Torque per unit of the parameter at a coordinate, zero where it does not act.
    GiNaC::ex column_at(int coordinate) const;
};

/// An interval of time: the symbol stands for `value`, 1 from t0 to before t1 and 0 elsewhere.
struct time_gate {
    double t0 = 0.0, t1 = 0.0;  ///< [s]
    GiNaC::symbol symbol;
    GiNaC::ex value;  ///< in the symbol t
};

/// What an effect remembers from sample to sample.
struct effect_memory {
    std::string name;  ///< "z2"
    GiNaC::symbol symbol;
    GiNaC::ex start;  ///< at the first sample of a motion
    GiNaC::ex next;   ///< at the sample that follows `step` later
};

/// What lies between a coordinate and the torque recorded for it.
struct drive_model {
    GiNaC::ex gain = 1;      ///< recorded torque per torque
    double delay = 0.0;      ///< of the record [s]
    double stiffness = 0.0;  ///< of the transmission [N*m/rad or N/m]; 0 where it is rigid
    double damping = 0.0;    ///< of the transmission [N*m*s/rad or N*s/m]
    /// Position, velocity and acceleration of the motor, joint side, where the transmission is not rigid: effects at
    /// the joint read these.
    std::array<GiNaC::symbol, 3> motor;

    bool is_elastic() const { return stiffness > 0.0; }
};

/// Everything a torque depends on linearly, link by link: ten inertial parameters unless the link is massless, then the
/// effects in declared order.
struct standard_parameters {
    std::vector<standard_parameter> all;
    GiNaC::symbol time{"t"};
    std::vector<GiNaC::symbol> temperature;   ///< per coordinate
    std::vector<GiNaC::symbol> rigid_torque;  ///< per coordinate: torque of the links and their payloads alone
    std::vector<drive_model> drives;          ///< per coordinate
    std::vector<time_gate> gates;
    std::vector<effect_memory> states;
    GiNaC::symbol step{"dt"};  ///< between samples [s]
    bool uses_time = false;
    bool uses_temperature = false;
    bool uses_rigid_torque = false;

    /// Index of an inertial parameter of a link; all.size() if the link is massless.
    std::size_t index(int link, parameter_kind kind) const;
    bool has_elastic_joint() const;
    /// An expression with the motion of the links in the place of that of the motors.
    GiNaC::ex without_elasticity(const kinematic_tree& tree, const GiNaC::ex& torque) const;
};

/// Lists the parameters of a tree with effects; `descriptions` holds one description per entry of `uses`. An effect
/// acts on the coordinate of its joint; at a joint without a coordinate of its own it takes the joint's variable and
/// acts on all coordinates that move it. Throws input_error where a torque is not linear in its coefficients, uses a
/// signal that it cannot have, or two effects name the same coefficient at one joint.
standard_parameters list_parameters(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                    const std::vector<effect_description>& descriptions);

}  // namespace idim::generator
