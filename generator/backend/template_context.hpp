#pragma once

#include <string>
#include <vector>

#include "graph/operation_count.hpp"

namespace idim::generator {

/// A function of the target language, spelled.
struct routine_context {
    std::string summary;                  ///< one sentence or more
    std::vector<std::string> meanings;    ///< of the arguments: "q [2] joint positions [rad or m]"
    std::string signature;                ///< without what ends a declaration or opens a body
    std::vector<std::string> prologue;    ///< statements before the body's own
    std::vector<std::string> statements;  ///< one per line (or several lines joined), each ending in ';'
};

/// A model over one scalar type.
struct variant_context {
    std::string scalar;  ///< "double"
    std::string suffix;  ///< of the names of functions and files
    bool calls_sign = false;
    std::vector<routine_context> routines;
};

/// One model, ready to be printed.
struct function_context {
    std::string name;                   ///< "regressor"
    std::string summary;                ///< one sentence
    std::vector<std::string> meanings;  ///< of the arguments of all its routines
    operation_count operations;
    std::vector<variant_context> variants;
};

struct joint_context {
    std::string name;
    bool prismatic = false;
    double drive_gain = 0.0;
    double velocity_limit = 0.0;
    std::string position_unit;
    double torque_delay = 0.0;  ///< [s]
    double stiffness = 0.0;     ///< 0 where the transmission is rigid
    double damping = 0.0;       ///< of a transmission that is not
};

struct parameter_context {
    std::string name, unit, regroups;
    bool per_log = false;  ///< every log has a value of its own
};

/// Everything the templates print: plain data, all decisions made.
struct template_context {
    std::string robot;
    std::string version;
    std::string robot_file;  ///< file name without its folder
    std::string input_hash;
    std::string cost;                    ///< name of the cost model
    std::vector<std::string> constants;  ///< "L = 0.5"
    std::vector<std::string> effects;    ///< "viscous_friction at j1, j2"
    std::vector<joint_context> joints;
    std::vector<parameter_context> base_parameters;
    std::vector<parameter_context> standard_parameters;
    bool uses_time = false;
    bool uses_temperature = false;
    bool uses_rigid_torque = false;
    bool has_elastic_joint = false;
    int closures = 0;  ///< loops that do not close everywhere
    bool has_payload = false;
    std::vector<std::string> states;  ///< of effects: "z2"
    int sines = 0;                    ///< cosines and sines that the models share
    std::vector<function_context> functions;
};

}  // namespace idim::generator
