#pragma once

#include <optional>
#include <vector>

#include "idim/estimate.hpp"

namespace idim {

/// What the residual of one joint looks like, on the rows of an identification.
struct residual_test {
    double lag_one = 0.0;             ///< correlation of neighbouring rows
    double correlation_length = 1.0;  ///< integrated autocorrelation time [rows]
    int lags = 0;                     ///< that the test of whiteness takes together
    /// Of Ljung and Box 1978 that the residual is white; none where the rows are too few.
    std::optional<double> whiteness_p;
    double skewness = 0.0;
    double excess_kurtosis = 0.0;  ///< 0 for a normal variable
    /// Of Jarque and Bera 1980 on rows thinned to one in the correlation length; none where these are too few.
    std::optional<double> normality_p;
    Eigen::Index thinned_rows = 0;
};

/// Tests the residual Y - W chi joint by joint; pairs across seams and gaps of left-out rows do not count. The p-values
/// say whether the plain deviations std_white and a normal law may be believed; the robust ones need neither.
std::vector<residual_test> test_residual(const observation& rows, const estimate& fit);

}  // namespace idim
