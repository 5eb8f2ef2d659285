#pragma once

#include <vector>

#include "dynamics/link_frame.hpp"

namespace idim::generator {

/// Motion of one link in its own frame. Letters as in Khalil and Dombre 2002, ch. 9.
struct link_motion {
    vector3 W;   ///< angular velocity [rad/s]
    vector3 WP;  ///< angular acceleration [rad/s^2]
    vector3 VP;  ///< acceleration of the origin of the link's frame, less gravity [m/s^2]
    /// U = skew(WP) + skew(W)^2, so that U p is the acceleration of a point p of the link relative to the origin.
    std::array<vector3, 3> U;
    GiNaC::ex WyWz, WxWz, WxWy;  ///< products shared by U and the inertia terms
    GiNaC::ex WxWx, WyWy, WzWz;
};

/// Which part of the motion a model needs.
struct motion_inputs {
    bool velocity = true;
    bool acceleration = true;
    bool gravity = true;
};

/// Outward recursion over all links; `frames` are those of the joints, same order.
std::vector<link_motion> propagate_motion(symbolic_model& model, const kinematic_tree& tree,
                                          const std::vector<link_frame>& frames, const motion_inputs& inputs);

/// Declares q, qd, qdd of the driven joints as leaves, as far as `inputs` has them, and builds the frames of all
/// joints.
std::vector<link_frame> declare_motion(symbolic_model& model, const kinematic_tree& tree, const motion_inputs& inputs);

}  // namespace idim::generator
