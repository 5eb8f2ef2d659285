#pragma once

#include <optional>

#include "compared_model.hpp"
#include "comparison/model_difference.hpp"
#include "idim/torque_comparison.hpp"

namespace idim::cli {

/// Two models and all that differs.
struct model_comparison {
    const compared_model& before;
    const compared_model& after;
    generator::model_difference difference;
    std::optional<torque_comparison> torques;  ///< nothing where they cannot be compared

    /// Nothing differs; torques may, by rounding.
    bool same() const;

    const char* joint_name(int joint) const;

    /// Of the torque or force of a joint.
    const char* unit(int joint) const;
};

}  // namespace idim::cli
