#pragma once

#include <Eigen/Core>
#include <vector>

namespace idim {

/// Rows that are at least `correlation_length` samples apart, from the first on; `places` are the samples at which the
/// rows stand, ascending. Returns row numbers.
std::vector<Eigen::Index> thinned_rows(const std::vector<Eigen::Index>& places, double correlation_length);

}  // namespace idim
