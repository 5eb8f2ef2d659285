#pragma once

#include <optional>
#include <string>
#include <vector>

#include "residual_structure.hpp"

namespace idim {

/// A torque fitted to a dependence from a grammar of its signals: a sum of terms, each with a linear coefficient, in
/// the words of an effect file (q, qd, qdd, tau_rigid, temp of the joint, q_from .. of the other one).
struct proposed_torque {
    std::vector<std::string> terms;
    std::vector<std::string> units;  ///< of the terms' coefficients
    std::optional<int> from;         ///< the other joint
};

/// From a grammar of functions of each signal and their products: the form that explains most of stretches of time it
/// was not fitted to, beside the model, or the simplest of those that do nearly as well. None where that is next to
/// nothing, or an effect of one joint and one other cannot hold the signals.
std::optional<proposed_torque> propose(const trace_fit& fit, const signal_dependence& dependence);

}  // namespace idim
