#pragma once

#include <vector>

#include "effect_evidence.hpp"

namespace idim {

/// The candidate at the shape that removes most from the residual of the fitted logs (variable projection: linear
/// coefficients are solved for at every shape [Golub and Pereyra 1973]). A grid whose neighbours are told apart by the
/// data, on columns without low-pass; then the best peaks by golden section on the exact ones. `promising` is the
/// corrected p-value of the grid above which the exact columns are not computed.
effect_evidence search_shape(const trace_fit& fit, const candidate_pointer& candidate, double promising);

/// A local search from a shape that was found before.
effect_evidence refine_shape(const trace_fit& fit, const effect_term& start, double reach);

}  // namespace idim
