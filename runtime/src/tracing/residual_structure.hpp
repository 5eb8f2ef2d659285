#pragma once

#include <vector>

#include "idim/effect_trace.hpp"
#include "joint_residual.hpp"
#include "trace_fit.hpp"

namespace idim {

/// What is left of a joint's residual that one or two signals tell.
struct signal_dependence {
    int joint = 0;
    std::vector<signal_source> signals;
    double explained_fraction = 0.0;  ///< of the residual variance away from reversals, on data held back
};

/// Joints whose residual still depends on any one or two signals, whatever the form: a surface of hat functions over
/// the signals is fitted beside the model. Reported where it explains a part of the data held back and where no shift
/// of the residual in time against the signals (a permutation in one block, which keeps both correlations) does as well
/// on the fitted rows, over all sets of signals and joints together [Westfall and Young 1993].
std::vector<signal_dependence> find_dependences(const trace_fit& fit);

}  // namespace idim
