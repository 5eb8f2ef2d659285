#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/robot_description.hpp"

namespace idim::generator {

enum class effect_scope { joint, pair, robot };

/// A coefficient that enters the torque linearly: one regressor column per joint.
struct linear_coefficient {
    std::string name;
    std::string unit;
    std::optional<double> min;
};

/// A coefficient that enters nonlinearly: fixed in the robot description or searched within its range.
struct shape_coefficient {
    std::string name;
    std::string unit;
    std::pair<double, double> range;
};

/// templates/effects/<effect>.yaml (FORMATS.md, "Effect description").
struct effect_description {
    std::string file;
    std::string name;
    effect_scope scope = effect_scope::joint;
    bool acts_on_both =
        false;  ///< pair effects: the same torque, roles exchanged, acts on the other joint with the same coefficients
    expression_text torque;
    std::vector<linear_coefficient> linear;
    std::vector<shape_coefficient> shape;
    std::string about;
};

/// Reads one effect file. Throws input_error.
effect_description read_effect(const std::string& file);

/// Finds `<effect>.yaml` first beside the robot description (its folder, and effects/ in it), then in `effects_folder`.
/// Throws input_error naming the robot's line and the folders searched when there is none.
effect_description find_effect(const effect_use& use, const robot_description& robot,
                               const std::string& effects_folder);

}  // namespace idim::generator
