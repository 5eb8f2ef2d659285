#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace idim::cli {

struct named_value {
    std::string name, unit;
    double value = 0.0;
};

/// What of a result of identify others can use.
struct exported_result {
    std::string version, robot, robot_file, method, input_hash;
    std::vector<named_value> base;
    std::vector<named_value> standard;  ///< one consistent set, of cwls; without those that move no torque
};

/// Throws input_error where the file is no result of identify with parameters.
exported_result read_result(const std::string& file);

/// A map that --parameters and --prior take.
std::string as_yaml(const exported_result& result);

/// Constants for C99 and C++17, in the order of the generated model with the same input_hash.
std::string as_header(const exported_result& result);

}  // namespace idim::cli
