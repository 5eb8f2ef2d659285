#pragma once

#include <vector>

#include "dynamics/link_axes.hpp"

namespace idim::generator {

using matrix3 = std::array<vector3, 3>;  ///< rows

/// Motion of one link in its axes. Letters as in Khalil and Dombre 2002, ch. 9.
struct link_motion {
    vector3 W;   ///< angular velocity [rad/s]
    vector3 WP;  ///< angular acceleration [rad/s^2]
    vector3 VP;  ///< acceleration of the origin of the link's frame, less gravity [m/s^2]
    /// U = skew(WP) + skew(W)^2, so that U p is the acceleration of a point p of the link relative to the origin.
    matrix3 U;
    GiNaC::ex WyWz, WxWz, WxWy;  ///< products shared by U and the inertia terms
    vector3 squares;             ///< of the components of W
};

/// Which part of the motion a model needs.
struct motion_inputs {
    bool velocity = true;
    bool acceleration = true;
    bool gravity = true;
};

/// Declares q, qd, qdd of the driven joints as leaves, as far as `inputs` has them, and defines what closed loops make
/// of them.
void declare_motion(symbolic_model& model, const kinematic_tree& tree, const motion_inputs& inputs);

/// Velocity and acceleration of a joint from those of its coordinates [rad or m per s, per s^2]. Without accelerations
/// a passive joint still has its drift.
struct joint_rates {
    GiNaC::ex velocity = 0, acceleration = 0;
};
joint_rates rates_of(symbolic_model& model, const kinematic_tree& tree, std::size_t joint, const motion_inputs& inputs);

/// Motion of the antecedent as a joint sees it: in the joint's axes, VP at the joint's origin.
struct carrying_motion {
    vector3 W, VP;
    matrix3 U;
    vector3 squares;
    GiNaC::ex WxWy, WP_z;
};

/// Outward recursion over all links.
class motion_recursion {
  public:
    motion_recursion(symbolic_model& model, const kinematic_tree& tree, const link_axes& axes,
                     const motion_inputs& inputs);

    const link_motion& of_link(std::size_t link) const { return links_[link]; }
    carrying_motion under_joint(std::size_t joint) const;

  private:
    const link_motion& before(std::size_t joint) const;
    link_motion step(std::size_t joint) const;
    void accelerate(std::size_t joint, const joint_rates& rates, link_motion& link) const;

    symbolic_model& model_;
    const kinematic_tree& tree_;
    const link_axes& axes_;
    motion_inputs inputs_;
    link_motion base_;
    std::vector<link_motion> links_;
};

}  // namespace idim::generator
