#pragma once

#include <optional>
#include <vector>

#include "effect_candidate.hpp"
#include "idim/effect_trace.hpp"

namespace idim {

/// Every effect of the catalogue at every joint or pair, but those that are in the model already.
std::vector<candidate_pointer> list_candidates(const trace_input& input, const std::vector<effect_term>& terms,
                                               const Eigen::VectorXd& chi);

/// The term of a step found before, with the step's shape; nothing where no candidate stands at its place.
std::optional<effect_term> term_of(const trace_step& step, const std::vector<candidate_pointer>& candidates);

}  // namespace idim
