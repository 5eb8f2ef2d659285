#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

namespace idim::test {

inline Eigen::VectorXd white_noise(Eigen::Index n, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd e(n);
    for (double& value : e) {
        value = normal(random);
    }
    return e;
}

/// Stationary e_k = phi e_{k-1} + eps_k of unit variance.
inline Eigen::VectorXd ar1_noise(Eigen::Index n, double phi, std::mt19937_64& random) {
    Eigen::VectorXd e = white_noise(n, random);
    for (Eigen::Index k = 1; k < n; ++k) {
        e[k] = phi * e[k - 1] + std::sqrt(1.0 - phi * phi) * e[k];
    }
    return e;
}

}  // namespace idim::test
