#pragma once

#include <vector>

#include "dynamics/link_axes.hpp"

namespace idim::generator {

/// A joint's axis as a link further out sees it: tau_i = e . n + m . f for a force f and a moment n at that link's
/// origin, in its axes.
struct carried_axis {
    vector3 e = {0, 0, 0};  ///< axis of a revolute joint, zero for a prismatic one
    vector3 m = {0, 0, 0};  ///< moment arm: e x (from the joint's origin to the link's), or a prismatic joint's axis
};

bool is_zero(const carried_axis& axis);
GiNaC::ex power(const carried_axis& axis, const vector3& force, const vector3& moment);

/// The axes of all coordinates, zero where one does not move the link.
using carried_axes = std::vector<carried_axis>;

/// Carries axes outward, link by link, as they are asked for.
class axis_recursion {
  public:
    axis_recursion(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes)
        : model_(model), tree_(tree), axes_(axes), links_(tree.joints.size()) {}

    /// As the link sees them, its own joint's among them.
    const carried_axes& at_link(std::size_t link);
    /// Those of the joints inward of a joint, in its antecedent's axes, the arms about the joint's own origin.
    carried_axes under_joint(std::size_t joint);

  private:
    carried_axes step(std::size_t link);

    symbolic_model& model_;
    const kinematic_tree& tree_;
    const link_axes& axes_;
    std::vector<carried_axes> links_;  ///< empty where not asked for yet
};

}  // namespace idim::generator
