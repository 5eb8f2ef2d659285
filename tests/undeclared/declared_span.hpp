#pragma once

#include <Eigen/QR>

#include "undeclared/declaration.hpp"
#include "undeclared/recording.hpp"

namespace idim::undeclared {

/// How an effect compares with the noise on the rows that an identification would use, by joint.
struct effect_strength {
    Eigen::VectorXd outside;   ///< deviation of its part outside the span of the declared model [N m or N]
    Eigen::VectorXd residual;  ///< deviation of what the declared model leaves of the same log without the effect
    Eigen::VectorXd whole;     ///< root mean square of the effect itself

    double largest_rho() const { return outside.cwiseQuotient(residual).maxCoeff(); }
};

/// All torques that the declared model can bring about along one log. Its columns come from MuJoCo, which is linear in
/// the inertial parameters too: ten bodies in the place of each link span all of them. Torques and columns are filtered
/// alike, forward and backward (Butterworth, order 4) at 15 Hz, and thinned to 2.5 rows a cycle of it; joints are
/// weighted by what the model leaves of each. Rows of a joint at rest (below a hundredth of its top speed) are zero: no
/// friction of the velocity describes them.
class declared_span {
  public:
    declared_span(const arm& robot, const declaration& declared, const recording& made);

    /// Of the effect in a log of the same motion, or nearly so.
    effect_strength strength_of(const recording& made) const;

  private:
    Eigen::VectorXd rows_of(const Eigen::MatrixXd& signals) const;
    void decompose(const Eigen::VectorXd& weight);
    Eigen::VectorXd outside(const Eigen::VectorXd& y) const;

    double rate_;            ///< of the log [Hz]
    Eigen::MatrixXd W_;      ///< rows of one sample's joints after another's
    Eigen::VectorXd moves_;  ///< 1, or 0 in the rows of a joint at rest
    Eigen::VectorXd inverse_weight_, residual_;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace idim::undeclared
