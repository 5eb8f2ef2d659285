#pragma once

#include "effect_candidate.hpp"
#include "idim/effect_interface.h"

namespace idim {

/// An effect of the compiled catalogue at one joint, or at a pair: its columns are generated code. `from` is -1 for an
/// effect of one joint.
candidate_pointer expression_candidate(const idim_effect& effect, int joint, int from);

}  // namespace idim
