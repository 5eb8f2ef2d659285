#pragma once

#include <vector>

#include "kinematics/planar_loop.hpp"
#include "kinematics/planar_vector.hpp"

namespace idim::generator {

/// The way from the link that both sides of a loop have in common to one point of the cut, in the plane in which the
/// links of the loop move, the passive joints not yet turned.
struct loop_side {
    /// From joint to joint of those that are passive, the first from the common link, the last to the cut.
    std::vector<planar_vector> segments;
    std::vector<int> passive;       ///< in the order of the way
    std::vector<int> sense;         ///< of each: +1 where its axis is the plane's normal, -1 where it is opposite
    std::vector<GiNaC::ex> turned;  ///< of each: the angle of the link before it
    GiNaC::ex height = 0;           ///< of the cut over the plane
};

/// Both sides: the first is the one with the first passive joint, about whose axis or against it the plane is seen.
struct loop_sides {
    loop_side first, second;
};

/// Throws input_error as close_loop does for what concerns the joints of the loop.
loop_sides walk_sides(const planar_loop& loop, const kinematic_tree& tree, const GiNaC::exmap& values);

}  // namespace idim::generator
