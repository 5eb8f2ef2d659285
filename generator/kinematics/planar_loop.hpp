#pragma once

#include <array>
#include <utility>
#include <vector>

#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// A loop_description with its entries symbolic.
struct planar_loop {
    struct cut_point {
        int link = -1;
        std::array<GiNaC::ex, 3> point;
    };
    std::array<cut_point, 2> cut;
    std::array<int, 2> passive = {-1, -1};
    loop_assembly assembly = loop_assembly::counterclockwise;
    input_location where, cut_where, passive_where, assembly_where;
    std::vector<std::pair<double, double>> ranges;  ///< of each coordinate, where the loop is expected to close
};

/// Gives the passive joints of a loop their angle, rates and drift as functions of the coordinates, in closed form: the
/// passive joints and the cut are the corners of a triangle whose sides the coordinates determine. With w and v the
/// sides from the two passive joints to the cut and r = w - v between those,
///   w = (k r + D Z r) / |r|^2,  k = (|w|^2 + |r|^2 - |v|^2) / 2,  D = w x v = +-sqrt(|w|^2 |r|^2 - k^2),
/// Z a quarter turn; angles are never formed. Rates follow from the velocity g that the coordinates alone give the gap
/// at the cut: with a', b' the turning of w and v, a' Z w - b' Z v + g = 0, so that a' = -g.v / D and b' = -g.w / D;
/// the drift likewise from accelerations. A parallelogram has angles linear in the coordinates.
///
/// Throws input_error where a passive joint is not in the loop, the links do not move in one plane, a joint of the loop
/// is moved by another loop in a nonlinear way, no coordinate moves the loop, it closes nowhere within the ranges, or
/// it is a parallelogram and is not said to be, or the reverse.
void close_loop(const planar_loop& loop, kinematic_tree& tree);

}  // namespace idim::generator
