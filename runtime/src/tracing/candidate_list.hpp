#pragma once

#include <vector>

#include "effect_candidate.hpp"
#include "idim/effect_trace.hpp"

namespace idim {

/// Every effect of the catalogue at every joint or pair, but those that are in the model already.
std::vector<candidate_pointer> list_candidates(const trace_input& input, const std::vector<effect_term>& terms,
                                               const Eigen::VectorXd& chi);

}  // namespace idim
