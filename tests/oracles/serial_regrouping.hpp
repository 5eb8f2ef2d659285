#pragma once

#include "oracles/mdh_row.hpp"

namespace idim::test {

/// Base parameters by the closed rules of M. Gautier and W. Khalil, "Direct calculation of minimum set of inertial
/// parameters of serial robots", IEEE Trans. Robotics and Automation 6(3), 1990, in the form of W. Khalil and E.
/// Dombre, "Modeling, identification and control of robots", 2002, section 9.4: for revolute chains whose first axis is
/// along gravity and whose second is perpendicular to it. Takes and gives numbers; the result has one entry for each
/// base parameter, under the name of the parameter that is kept (XX2 for XX2R). Ia1 and Ia2 are regrouped, other
/// effects are kept as they are.
value_table regroup_serial(const mdh_table& table, value_table standard);

}  // namespace idim::test
