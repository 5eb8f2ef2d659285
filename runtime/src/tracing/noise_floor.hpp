#pragma once

#include <vector>

#include "idim/effect_trace.hpp"
#include "traced_log.hpp"

namespace idim {

/// Deviation of the noise in the rows of each joint, from the spectrum of the measured torque above twice the band of
/// the rows, where the motion has nothing: its median density times the band. Empty where the samples reach no further.
noise_floor floor_from_spectrum(const std::vector<traced_log>& logs);

}  // namespace idim
