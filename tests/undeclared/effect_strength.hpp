#pragma once

#include <Eigen/Core>

#include "undeclared/declaration.hpp"
#include "undeclared/recording.hpp"

namespace idim::undeclared {

/// How an effect compares with the noise on the rows that an identification would use, by joint.
struct effect_strength {
    Eigen::VectorXd outside;   ///< deviation of its part outside the span of the declared model [N m or N]
    Eigen::VectorXd residual;  ///< deviation of what the declared model leaves of the same log without the effect
    Eigen::VectorXd whole;     ///< root mean square of the effect itself

    double rho(int joint) const { return outside[joint] / residual[joint]; }
    double largest_rho() const { return outside.cwiseQuotient(residual).maxCoeff(); }
};

/// The declared model's columns come from MuJoCo, which is linear in the inertial parameters too: ten bodies in the
/// place of each link span all of them. Signals are filtered forward and backward (Butterworth, order 4) at `cutoff`
/// [Hz] and thinned to 2.5 rows a cycle of it; joints are weighted by what each leaves.
effect_strength strength_of(const arm& robot, const declaration& declared, const recording& made, double cutoff);

}  // namespace idim::undeclared
