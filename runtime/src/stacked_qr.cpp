#include "stacked_qr.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace idim {

namespace {

constexpr double rank_tolerance = 1e-10;
constexpr double null_space_tolerance = 1e-5;

/// Upper triangle of A, min(rows, cols) x cols.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd A) {
    const Eigen::Index height = std::min(A.rows(), A.cols());
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(A);
    return A.topRows(height).triangularView<Eigen::Upper>();
}

/// Triangle of [W Y] of one joint in one block. A joint does not feel the links before it: its columns of zeros stay
/// out.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& W, const Eigen::VectorXd& Y, const Eigen::VectorXd& weight) {
    std::vector<Eigen::Index> felt;
    for (Eigen::Index c = 0; c < W.cols(); ++c) {
        if (!W.col(c).isZero(0.0)) {
            felt.push_back(c);
        }
    }
    Eigen::MatrixXd A(W.rows(), static_cast<Eigen::Index>(felt.size()) + 1);
    A << W(Eigen::all, felt), Y;
    A = weight.asDiagonal() * A;
    const Eigen::MatrixXd small = triangle_of(std::move(A));

    felt.push_back(W.cols());
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(small.rows(), W.cols() + 1);
    spread(Eigen::all, felt) = small;
    return spread;
}

/// Triangle of two stacked ones, padded with rows of zeros to a square.
Eigen::MatrixXd combine(const Eigen::MatrixXd& upper, const Eigen::MatrixXd& lower) {
    Eigen::MatrixXd A(upper.rows() + lower.rows(), upper.cols());
    A << upper, lower;
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(A.cols(), A.cols());
    const Eigen::MatrixXd triangle = triangle_of(std::move(A));
    square.topRows(triangle.rows()) = triangle;
    return square;
}

double capped_ratio(const Eigen::VectorXd& singular_values) {
    const double largest = singular_values.size() > 0 ? singular_values[0] : 0.0;
    if (largest == 0.0) {
        return 1.0 / std::numeric_limits<double>::epsilon();
    }
    const double smallest = singular_values[singular_values.size() - 1];
    return largest / std::max(smallest, std::numeric_limits<double>::epsilon() * largest);
}

}  // namespace

Eigen::VectorXd stacked_qr::solve() const {
    return R.triangularView<Eigen::Upper>().solve(z).cwiseQuotient(column_norm);
}

Eigen::MatrixXd stacked_qr::inverse() const {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(R.rows(), R.cols());
    return column_norm.cwiseInverse().asDiagonal() * R.triangularView<Eigen::Upper>().solve(identity);
}

std::vector<double> stacked_qr::parameter_share() const {
    std::vector<double> share;
    for (const Eigen::MatrixXd& T : joints) {
        share.push_back(R.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(T).squaredNorm());
    }
    return share;
}

stacked_qr factor(const observation& rows, const joint_series& weights) {
    const Eigen::Index b = rows.n_base;
    const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(0, b + 1);
    Eigen::MatrixXd all = combine(nothing, nothing);
    stacked_qr qr;
    for (std::size_t j = 0; j < weights.size(); ++j) {
        Eigen::MatrixXd joint = combine(nothing, nothing);
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            joint = combine(joint, triangle_of(rows.blocks[i].W[j], rows.blocks[i].Y[j], weights[j][i]));
        }
        qr.joints.push_back(joint.topLeftCorner(b, b));
        all = combine(all, joint);
    }
    qr.R = all.topLeftCorner(b, b);
    qr.z = all.col(b).head(b);
    // Reflections do not mix columns, so that dividing the columns of R by their norms is the factorisation of scaled
    // rows.
    qr.column_norm = qr.R.colwise().norm().transpose();
    qr.column_norm = (qr.column_norm.array() > 0.0).select(qr.column_norm, 1.0);
    const Eigen::VectorXd scale = qr.column_norm.cwiseInverse();
    qr.R = qr.R * scale.asDiagonal();
    for (Eigen::MatrixXd& T : qr.joints) {
        T = T * scale.asDiagonal();
    }
    return qr;
}

joint_series uniform_weights(const observation& rows, const std::vector<double>& joint_weight) {
    joint_series weights(joint_weight.size());
    for (std::size_t j = 0; j < joint_weight.size(); ++j) {
        for (const observation_block& block : rows.blocks) {
            weights[j].push_back(Eigen::VectorXd::Constant(block.Y[j].size(), joint_weight[j]));
        }
    }
    return weights;
}

rank_report examine(const stacked_qr& qr) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> scaled(qr.R, Eigen::ComputeFullV);
    const Eigen::VectorXd& s = scaled.singularValues();
    const Eigen::MatrixXd unscaled = qr.R * qr.column_norm.asDiagonal();
    rank_report report;
    report.condition_number = capped_ratio(Eigen::JacobiSVD<Eigen::MatrixXd>(unscaled).singularValues());
    report.scaled_condition_number = capped_ratio(s);
    report.rank = static_cast<int>((s.array() > rank_tolerance * s.maxCoeff()).count());
    const Eigen::MatrixXd null_space = scaled.matrixV().rightCols(s.size() - report.rank);
    for (Eigen::Index c = 0; c < null_space.rows(); ++c) {
        if (null_space.row(c).norm() > null_space_tolerance) {
            report.not_excited.push_back(static_cast<int>(c));
        }
    }
    return report;
}

}  // namespace idim
