#pragma once

#include <Eigen/Core>

namespace idim::test {

/// What a robot of one joint has for each joint.
inline Eigen::VectorXd one(double value) {
    return Eigen::VectorXd::Constant(1, value);
}

}  // namespace idim::test
