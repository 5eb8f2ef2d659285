#pragma once

#include <Eigen/Core>

#include "idim/excitation_search.hpp"

namespace idim {

/// A smooth function of the Gram matrix G = W'W / N [b x b] and its derivative.
struct gram_value {
    double value = 0.0;
    Eigen::MatrixXd derivative;  ///< by G, symmetric
    double figure = 0.0;         ///< condition number of W, or log det G
};

/// condition: (log tr S^p + log tr S^-p) / 2p over the scaled Gram matrix S, which tends to the log of the condition
/// number for large p; unscaled_condition: the same over G. information: -log det G / 2b, p is not used.
gram_value criterion_of(const Eigen::MatrixXd& G, excitation_criterion criterion, double p);

}  // namespace idim
