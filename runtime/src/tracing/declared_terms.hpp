#pragma once

#include <vector>

#include "idim/effect_trace.hpp"
#include "trace_fit.hpp"

namespace idim {

/// A term of the description whose coefficients are base parameters of their own: a rotor inertia that is part of ZZ1R
/// is none.
struct declared_term {
    effect_place place;
    std::vector<Eigen::Index> columns;  ///< base parameters, in order
};

/// Those of the effects that the description has.
std::vector<declared_term> separable_terms(const trace_input& input);

/// Backward elimination of declared terms that the data does not support: by partial F on effective rows they are not
/// significant, and data held back is predicted as well without them. The least significant one first; errors are those
/// without it and all before it.
std::vector<unsupported_term> find_unsupported(const trace_fit& fit, const trace_input& input);

}  // namespace idim
