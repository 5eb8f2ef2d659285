#pragma once

#include "trace_fit.hpp"

namespace idim {

/// Coefficients of a term, linear ones first, then shapes, with deviations robust to the autocorrelation of the
/// residual (sandwich.hpp): the regressor gets a column for each shape, the derivative of the term's torque with
/// respect to it.
struct term_values {
    Eigen::VectorXd value;
    Eigen::VectorXd deviation;
};

/// Of every term of the fit.
std::vector<term_values> values_with_deviations(const trace_fit& fit);

}  // namespace idim
