#pragma once

#include "idim/estimate.hpp"

namespace idim {

/// Total least squares: the smallest change of regressor and torque together that makes the rows agree, |[dW dY]| in
/// the Frobenius norm [Golub and Van Loan 1980, SIAM J. Numerical Analysis 17; with robots Gautier, Vandanjon and
/// Presse 1994]. Rows of joint j are divided by the deviation of that joint's own OLS error, and every column by its
/// norm: the method supposes that the errors of all columns are in proportion to their size and independent of one
/// another. Errors of differentiated positions are neither (the offset's column has none, accelerations have most), so
/// the estimate is offered for comparison.
///
/// Deviations: chi = (W'W - s^2 D^2)^-1 W'Y with s the smallest singular value of the scaled [W Y] and D the norms of
/// the columns, hence to first order that inverse times W' rho [Van Huffel and Vandewalle 1991, The Total Least Squares
/// Problem, section 8.5]; made robust to autocorrelation as all others.
estimate total_least_squares(const observation& rows);

}  // namespace idim
