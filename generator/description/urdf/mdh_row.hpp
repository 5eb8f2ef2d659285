#pragma once

#include "description/urdf/common_normal.hpp"

namespace idim::generator {

/// A frame of the modified Denavit-Hartenberg kind, in the base frame: z along the axis of the joint that moves it.
struct axis_frame {
    decimal_vector origin = decimal_vector::Zero();
    decimal_vector x = decimal_vector::UnitX();
    decimal_vector z = decimal_vector::UnitZ();

    spatial_line axis() const { return {origin, z}; }
};

/// A frame in its antecedent is Rot(z,gamma) Trans(z,b) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r) (Khalil and
/// Kleinfinger 1986). Angles in radians, lengths in metres.
struct mdh_row {
    decimal gamma = 0, b = 0, alpha = 0, d = 0, theta = 0, r = 0;
};

/// The direction after gamma: along the common normal of both axes, where it is nearer to the antecedent's x than to
/// its opposite; that x itself where the axes are one line.
decimal_vector normal_direction(const axis_frame& antecedent, const spatial_line& axis);

mdh_row row_between(const axis_frame& antecedent, const axis_frame& frame);

}  // namespace idim::generator
