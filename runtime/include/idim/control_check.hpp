#pragma once

#include <vector>

#include "idim/control_law.hpp"
#include "idim/log.hpp"

namespace idim {

/// How well a law reproduces the drive command of one joint.
struct joint_control_check {
    double recorded_rms = 0.0;  ///< of the recorded command
    double rms = 0.0;           ///< of recorded - computed, as declared
    double share = 0.0;         ///< rms / recorded_rms
    int best_delay = 0;     ///< [samples] by which the computed command fits best if it comes later; negative: earlier
    double best_rms = 0.0;  ///< at that delay
};

/// The declared law fed with recorded positions and reference, against the recorded drive signal (v, or tau over the
/// drive gain). A law that uses speeds gets the recorded ones, or else the backward difference of the positions. The
/// first `settling` samples do not count: a law has memory, and the log may begin in the midst of a motion. Throws
/// input_error where the log has no reference, too few samples, or another rate than the law (by more than 1 %).
std::vector<joint_control_check> check_control(const control_law& law, const log& recorded, int settling = 50);

}  // namespace idim
