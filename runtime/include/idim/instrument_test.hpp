#pragma once

#include "idim/estimate.hpp"

namespace idim {

/// Is the measured regressor fit for least squares? Bias of least squares against the instrumental variable, and the
/// revised Durbin-Wu-Hausman test of it [Janot, Vandanjon and Gautier 2016, "A revised Durbin-Wu-Hausman test for
/// industrial robot identification", Control Engineering Practice 48]: the torque is regressed on W and on what of W
/// the instruments V do not explain, E = W - V (V'V)^-1 V'W; under the hypothesis that W is not correlated with the
/// error the coefficients of E are zero. Rows of joint j are divided by the deviation of its residual and thinned to
/// one in its correlation length, without which the test rejects differences that mean nothing.
struct instrument_test {
    Eigen::VectorXd bias_percent;        ///< [b] 100 (chi_LS - chi_IV) / |chi_IV|
    Eigen::VectorXd bias_in_deviations;  ///< [b] (chi_LS - chi_IV) / robust deviation of chi_IV
    double f_statistic = 0.0;
    int tested = 0;         ///< independent columns of E, numerator degrees of freedom
    Eigen::Index rows = 0;  ///< after thinning
    double p_value = 1.0;   ///< 1 where nothing could be tested
    std::string message;    ///< one sentence for the report
};

/// `instruments`: V on the rows of `rows`. `ls` and `iv` must both have parameters.
instrument_test durbin_wu_hausman(const observation& rows, const observation& instruments, const estimate& ls,
                                  const estimate& iv);

}  // namespace idim
