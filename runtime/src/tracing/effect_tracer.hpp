#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "effect_evidence.hpp"
#include "idim/effect_trace.hpp"
#include "trace_fit.hpp"

namespace idim {

/// A candidate that was tried and what the data says of it.
struct tried_candidate {
    effect_evidence evidence;
    double p_value = 1.0;   ///< corrected for all that was tried
    std::string objection;  ///< why it is not accepted; empty if it is
};

/// A candidate whose columns are combinations of the model's own.
struct hidden_candidate {
    effect_place place;
    std::vector<Eigen::Index> absorbed_by;  ///< columns of the fit that take it up, most of it first
};

/// One look at the residual: every candidate, most likely first.
struct effect_survey {
    std::vector<tried_candidate> candidates;
    std::vector<hidden_candidate> within_span;  ///< no residual of this motion can show them
    double tests = 0.0;                         ///< candidates and shapes tried
};

/// Tries every candidate against the residual of `fit`; nothing where `go_on`, which may be empty, said no meanwhile.
std::optional<effect_survey> survey(const trace_fit& fit, const std::vector<candidate_pointer>& candidates,
                                    const std::function<bool()>& go_on = {});

/// The candidates that the data cannot tell from the accepted one: what they predict outside the span of the model
/// correlates, and neither fits better by more than chance.
std::vector<effect_place> confusable_with(const trace_fit& fit, const effect_survey& all, std::size_t accepted);

/// Shapes of all terms searched again, one after the other, until nothing moves.
trace_fit with_refined_shapes(const trace_fit& fit);

/// Place of a term that the others have made needless, or none.
std::optional<std::size_t> needless_term(const trace_fit& fit, std::size_t first_removable);

}  // namespace idim
