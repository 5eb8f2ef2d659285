#pragma once

#include <vector>

#include "dynamics/link_frame.hpp"
#include "dynamics/model_form.hpp"

namespace idim::generator {

/// The axes in which the quantities of each link are written, at the origin of its frame: those of its frame, or those
/// before its own joint has turned it.
struct link_axes {
    std::vector<link_frame> frames;  ///< from the antecedent's axes to the link's
    std::vector<angle_pair> lag;     ///< turns the link's axes to its frame, about z; identity where they are the same
    std::vector<link_frame> in_own_frame;  ///< from the antecedent's frame to the joint's, both fixed to their links
    std::vector<bool> is_tip;              ///< no joint is outward of it
};

/// A link beyond the first is followed by joints with axes parallel to its own, so that angles may be added.
bool has_parallel_axes(const kinematic_tree& tree);

/// The last link before the axes of the joints that follow begin to intersect, with another link before it: what a
/// wrist's wrench does to the joints inward is simplest seen from there. -1 where there is none.
int last_before_wrist(const kinematic_tree& tree);

/// Axes of all links. Tips that a form merges keep the axes before their joint.
link_axes lay_axes(symbolic_model& model, const kinematic_tree& tree, const model_form& form);

}  // namespace idim::generator
