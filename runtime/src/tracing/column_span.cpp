#include "column_span.hpp"

#include <Eigen/QR>

namespace idim {

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& A) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
    qr.setThreshold(1e-6);
    qr.compute(A);
    Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(A.rows(), qr.rank());
    Q.applyOnTheLeft(qr.householderQ());
    return Q;
}

Eigen::MatrixXd outside(const Eigen::MatrixXd& span, const Eigen::MatrixXd& A) {
    return A - span * (span.transpose() * A);
}

}  // namespace idim
