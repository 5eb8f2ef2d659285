#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "description/inertial_parameters.hpp"
#include "idim/input_error.hpp"

namespace idim::generator {

/// Text of an entry that may be an expression ("q + pi/2", "-l3x"), with the place it was read from.
struct expression_text {
    std::string text = "0";
    input_location where;
};

inline constexpr std::size_t most_joints = 200;

/// Of the name of a control law that is a user's header.
inline constexpr std::string_view header_ending = ".hpp";

enum class joint_type { revolute, prismatic, fixed };

inline constexpr int base_link = -1;  ///< antecedent of a joint that stands on the base

struct joint_limits {
    std::optional<std::pair<double, double>> position;  ///< [rad or m]
    std::optional<double> velocity;                     ///< [rad/s or m/s]
    std::optional<double> effort;                       ///< [N*m or N]
};

/// One modified Denavit-Hartenberg row (METHODS.md, "Model"): the frame of this joint's link in that of its antecedent
/// is Rot(z,gamma) Trans(z,b) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r). Angles in radians, lengths in metres.
/// The variable of a joint that moves, theta or r, is an expression of its own coordinate `q` and of those of other
/// joints, `q_<name>`; one without `q` has no coordinate of its own and moves with the others.
struct joint_description {
    std::string name;
    joint_type type = joint_type::revolute;
    int antecedent = base_link;  ///< index in robot_description::joints, always smaller than the joint's own
    expression_text gamma, b, alpha, d, theta, r;
    bool massless = false;  ///< its link has no inertia: no inertial parameters
    bool passive = false;   ///< a loop determines its variable, which is written `q`
    joint_limits limits;
    std::optional<double> drive_gain;  ///< [N*m or N] per unit of v
    input_location where;
};

/// A named length or angle; the value may be an expression of constants declared before it.
struct constant_description {
    std::string name;
    expression_text value;
};

/// A point fixed to a link, in the frame of its joint [m].
struct link_point {
    int link = -1;  ///< index in robot_description::joints; -1 is the base
    std::array<expression_text, 3> point;
};

/// The two ways in which a triangle closes over its base, or a parallelogram, which keeps its form past the position
/// where all its sides lie in one line.
enum class loop_assembly { clockwise = -1, parallelogram = 0, counterclockwise = 1 };

/// A closed loop of links that move in a plane, cut open at a revolute joint: the tree of `joints` with the two points
/// of the cut at one place. It determines the two passive joints, with which the cut joint forms a triangle (Khalil and
/// Dombre 2002, ch. 7).
struct loop_description {
    std::array<link_point, 2> cut;
    std::array<int, 2> passive = {-1, -1};  ///< indices of joints
    /// The sense of the corners first passive joint, second one, cut, seen against the axis of the first.
    loop_assembly assembly = loop_assembly::counterclockwise;
    input_location where, cut_where, passive_where, assembly_where;
};

/// An effect as a robot uses it.
struct effect_use {
    std::string effect;
    std::vector<int> joints;  ///< indices of the joints it acts on
    std::vector<int> from;    ///< for pair effects: index of the other joint, one for each entry of `joints`
    std::map<std::string, double> shape;
    input_location where;
};

/// How the robot is controlled; read and checked where a simulation needs it.
struct control_description {
    std::string law;    ///< a name, or a header beside the description, such as my_law.hpp
    double rate = 0.0;  ///< [Hz]
    std::map<std::string, std::vector<double>>
        values;          ///< wn, zeta, kp, kv, saturation ...: one number per driven joint
    double delay = 0.0;  ///< [s]
    input_location where;
};

/// Whether the law is the user's own: its name is that of a header.
bool is_header(const control_description& control);

/// What the user wrote, checked for form but not for meaning: the only stage that knows the file format (FORMATS.md).
struct robot_description {
    std::string file;
    std::string urdf_file;  ///< that it is or names; empty for one of frames
    std::string name;
    std::vector<expression_text> gravity;  ///< three entries [m/s^2], base frame
    std::vector<constant_description> constants;
    std::vector<joint_description> joints;
    std::vector<loop_description> loops;
    std::vector<effect_use> effects;
    std::optional<control_description> control;
    std::map<std::string, double> parameters;  ///< a-priori standard parameters
    std::vector<link_placement> links;         ///< of a URDF: one for each joint, where its link stands in our frame
    std::vector<std::string> notes;            ///< what a user should know of how the file was read
};

/// Reads robots/<name>/<name>.yaml, or a .urdf file. A YAML file may name one in the place of joints (urdf: arm.urdf,
/// from its own folder); its `parameters` come before those of the URDF. A bare .urdf file is a robot of its name under
/// gravity along -z of its root link, with rotor inertia, viscous and Coulomb friction at every joint but those that
/// mimic others, and planar and floating ones. <dynamics> gives Fv and Fc where these effects act. Throws input_error,
/// one line naming file, line, field and what was expected.
robot_description read_robot(const std::string& file);

/// Whether the joint's variable names its own coordinate `q`: otherwise it is fixed or moves with other joints, as a
/// passive one does whose `q` a loop determines.
bool has_own_coordinate(const joint_description& joint);

/// Joints that have a coordinate of their own, in order.
std::vector<int> driven_joints(const std::vector<joint_description>& joints);

/// The name of a joint, which is that of its link, or "base" for -1.
std::string link_name(const std::vector<joint_description>& joints, int link);

/// Behind the name of every parameter of this joint and its link: the number of its coordinate from 1, or else _<name>.
std::string parameter_label(const std::vector<joint_description>& joints, int joint);

/// Readable YAML-like listing of a description, for tests and messages.
std::string to_string(const robot_description& robot);

}  // namespace idim::generator
