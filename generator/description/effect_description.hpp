#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/robot_description.hpp"

namespace idim::generator {

enum class effect_scope { joint, pair, robot };

/// What an effect is to the model: a torque given by an expression, or something that is derived from the model itself.
enum class effect_kind {
    expression,
    delay,       ///< the torque of the joint is measured late, by the shape Td [s]
    gain,        ///< the torque of the joint is scaled by 1 + Ke
    elasticity,  ///< the link swings behind its motor, held by the stiffness K and the damping D
    tilt,        ///< gravity is turned by tilt_x, tilt_y about axes x and y of the base [rad]
    payload,     ///< ten inertial parameters at the link, from t0 to t1 [s]
};

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

/// A state of an effect with memory, with its own discrete update along the samples. Expressions of the signals, the
/// shapes, all states and, in `next`, the step `dt` [s].
struct effect_state {
    std::string name;
    expression_text start;  ///< at the first sample
    expression_text next;   ///< at the following sample
};

/// templates/effects/<effect>.yaml (FORMATS.md, "Effect description").
struct effect_description {
    std::string file;
    std::string name;
    effect_scope scope = effect_scope::joint;
    bool acts_on_both =
        false;  ///< pair effects: the same torque, roles exchanged, acts on the other joint with the same coefficients
    effect_kind kind = effect_kind::expression;
    expression_text torque;  ///< of kind expression only
    /// The torque where there is no temperature; its shapes are those that `torque` does not use.
    std::optional<expression_text> torque_without_temperature;
    bool per_log = false;  ///< the linear coefficients of every log are its own, such as those of a phase
    std::vector<effect_state> states;
    std::vector<linear_coefficient> linear;
    std::vector<shape_coefficient> shape;
    std::string about;
};

/// What an effect does, in one line: its torque and its states, or its kind.
std::string law_of(const effect_description& effect);

/// Reads one effect file. Throws input_error.
effect_description read_effect(const std::string& file);

/// Finds `<effect>.yaml` first beside the robot description (its folder, and effects/ in it), then in `effects_folder`.
/// Throws input_error naming the robot's line and the folders searched when there is none.
effect_description find_effect(const effect_use& use, const robot_description& robot,
                               const std::string& effects_folder);

}  // namespace idim::generator
