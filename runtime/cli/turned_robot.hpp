#pragma once

#include <string>
#include <vector>

#include "idim/compiled_model.hpp"

namespace idim::cli {

/// The model of a robot with gravity turned by a small angle.
struct turned_robot {
    std::string shape;  ///< of base_tilt
    double angle;       ///< [rad]
    compiled_model model;
};

/// About each axis of the base that the declared gravity is not along; none without gravity.
std::vector<turned_robot> load_turned(const std::string& robot_file);

}  // namespace idim::cli
