#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/input_error.hpp"

namespace idim {

/// Median step of strictly increasing times [s].
double median_period(const Eigen::VectorXd& t);

/// Whether all times lie within `tolerance` of a period of a uniform grid over the same duration.
bool is_uniform(const Eigen::VectorXd& t, double tolerance);

/// Rate of uniform times [Hz], from their whole duration. Throws input_error with the location if there are fewer
/// than 2.
double uniform_rate(const Eigen::VectorXd& t, const input_location& where);

/// One log's name and rate [Hz].
struct named_rate {
    std::string file;
    double rate = 0.0;
};

/// Throws input_error naming two logs and both rates if they differ by more than 5 %: one decimation would then keep
/// different bands. Smaller differences are the clocks': the median periods of the two halves of data/panda differ by 1
/// %.
void require_common_rate(const std::vector<named_rate>& logs);

}  // namespace idim
