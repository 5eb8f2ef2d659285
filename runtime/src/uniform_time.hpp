#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/input_error.hpp"
#include "idim/log.hpp"

namespace idim {

/// Median step of strictly increasing times [s].
double median_period(const Eigen::VectorXd& t);

/// Whether all times lie within `tolerance` of a period of a uniform grid over the same duration.
bool is_uniform(const Eigen::VectorXd& t, double tolerance);

/// Samples of a uniform grid at the median step of a log from its first time on; the last sample belongs to the grid
/// even if rounding puts it just before its grid time.
Eigen::Index grid_samples(double duration, double period);

/// Every signal at the times of `grid`, ascending and within the log, by cubic interpolation that takes two samples on
/// both sides.
log interpolated(const log& data, const Eigen::VectorXd& grid);

/// Rate of uniform times [Hz], from their whole duration. Throws input_error with the location if there are fewer
/// than 2.
double uniform_rate(Eigen::Index samples, double duration, const input_location& where);
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
