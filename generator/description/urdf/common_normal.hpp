#pragma once

#include "description/decimal.hpp"

namespace idim::generator {

/// A line in space: direction of unit length.
struct spatial_line {
    decimal_vector point = decimal_vector::Zero();
    decimal_vector direction = decimal_vector::UnitZ();

    decimal_vector at(const decimal& distance) const { return point + distance * direction; }
};

/// The line that meets two others at right angles. Parallel lines have many: then the one through the first's point.
struct common_normal {
    bool parallel = false;
    decimal_vector direction = decimal_vector::Zero();  ///< unit length; zero where the lines are one
    decimal first = 0;   ///< where it meets the first line, from that line's point along its direction [m]
    decimal second = 0;  ///< likewise on the second line
    decimal length = 0;  ///< from the first line to the second along `direction` [m]
};

common_normal normal_between(const spatial_line& first, const spatial_line& second);

}  // namespace idim::generator
