#pragma once

#include <vector>

#include "dynamics/link_axes.hpp"
#include "dynamics/mass_moments.hpp"

namespace idim::generator {

bool is_merged(const kinematic_tree& tree, const link_axes& axes, const model_form& form, std::size_t joint);

/// The bodies that a form of the equations is written for.
struct link_bodies {
    std::vector<mass_moments> link;   ///< each link with what is merged into it, in its axes
    std::vector<mass_moments> joint;  ///< the same in its joint's axes, where the joint is merged
};

link_bodies gather_bodies(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes,
                          const parameter_values& values, const model_form& form);

}  // namespace idim::generator
