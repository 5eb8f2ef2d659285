#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/filtered_samples.hpp"

namespace idim {

/// Relative distance of two motions of one joint, |a - b| / |b| over all samples: position, velocity, acceleration.
/// 1 where b is zero and a is not.
struct motion_distance {
    double q = 0.0;
    double qd = 0.0;
    double qdd = 0.0;
};

/// Distance per joint of `motion` from `from`, over all logs and the samples from `start` [s] after the beginning of
/// each on [IV figures 8-9]. Both must hold the same samples, filtered alike.
std::vector<motion_distance> distances(const std::vector<filtered_samples>& motion,
                                       const std::vector<filtered_samples>& from, double start);

}  // namespace idim
