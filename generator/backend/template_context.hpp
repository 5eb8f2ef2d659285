#pragma once

#include <string>
#include <vector>

#include "graph/operation_count.hpp"

namespace idim::generator {

/// One array argument of a generated function.
struct argument_context {
    std::string name;
    std::string declaration;  ///< "const Scalar* q"
    std::string meaning;      ///< "q [2] joint positions [rad or m]"
    bool is_output = false;
    bool used = true;  ///< the body reads or writes it
};

/// One generated function, ready to be printed.
struct function_context {
    std::string name;     ///< "regressor"
    std::string summary;  ///< one sentence
    std::vector<argument_context> arguments;
    operation_count operations;
    std::vector<std::string> functions;   ///< of <cmath> in the body: "cos", "sin"
    std::vector<std::string> statements;  ///< one per line (or several lines joined), each ending in ';'
};

struct joint_context {
    std::string name;
    bool prismatic = false;
    double drive_gain = 0.0;
    double velocity_limit = 0.0;
    std::string position_unit;
};

struct parameter_context {
    std::string name, unit, regroups;
};

/// Everything the templates print: plain data, all decisions made.
struct template_context {
    std::string robot;
    std::string version;
    std::string robot_file;  ///< file name without its folder
    std::string input_hash;
    std::vector<std::string> constants;  ///< "L = 0.5"
    std::vector<std::string> effects;    ///< "viscous_friction at j1, j2"
    std::vector<joint_context> joints;
    std::vector<parameter_context> base_parameters;
    std::vector<parameter_context> standard_parameters;
    bool uses_time = false;
    bool uses_temperature = false;
    std::vector<function_context> functions;
};

}  // namespace idim::generator
