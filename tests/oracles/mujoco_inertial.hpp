#pragma once

#include <string>

#include "oracles/rigid_link.hpp"

namespace idim::test {

/// The element <inertial> of a link in MuJoCo's XML, in principal axes: its own search for them stops at 1e-7.
std::string mujoco_inertial(const rigid_link& link);

}  // namespace idim::test
