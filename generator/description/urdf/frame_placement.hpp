#pragma once

#include <vector>

#include "description/urdf/mdh_row.hpp"
#include "description/urdf/moving_axis.hpp"

namespace idim::generator {

/// A frame on every axis, at joint positions zero. z is the axis. x is along the common normal to the first axis that
/// moves with this one (its main successor), with the origin at the foot, so that gamma and b of that one are zero as
/// in a chain; its sense is the one that turns theta least. Where geometry leaves a choice, it is the one with the
/// fewest operations (measured on chains of six joints):
///  - parallel axes have many normals: the one through the origin that the antecedent's normal gives, so that the
///    offset along the axis is r of the successor, not r of this joint;
///  - a prismatic axis may lie anywhere: through the origin of its antecedent (d = 0), r absorbs what it can, the rest
///    is d and r of the successor; beside it by d where x would otherwise turn by a constant oblique angle;
///  - an axis without successor: origin and x where the antecedent's normal ends, so that theta and r are zero there;
///  - offsets that cost nothing, because no axis inward turns them, are taken as far inward as possible.
std::vector<axis_frame> place_frames(const std::vector<moving_axis>& axes);

}  // namespace idim::generator
