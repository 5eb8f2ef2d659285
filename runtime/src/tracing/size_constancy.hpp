#pragma once

#include <cstddef>
#include <optional>

#include "trace_fit.hpp"

namespace idim {

/// The joint whose position changes the size of term `term`, or none. An effect of the catalogue at one joint has one
/// size, wherever the others stand: what changes with another joint's position is some other effect in its guise. Tests
/// the term's own torque times that position and its square, columns beside all others, on all logs together, for only
/// a name is in question and nothing is predicted: partial F corrected for the joints tried, a gain on every log, and a
/// change that is a good part of the term itself. Terms that touch several joints, or that are fitted to each log, are
/// not tested.
std::optional<int> joint_that_changes(const trace_fit& fit, std::size_t term);

}  // namespace idim
