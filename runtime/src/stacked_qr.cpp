#include "stacked_qr.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <numeric>

namespace idim {

namespace {

constexpr double rank_tolerance = 1e-10;
constexpr double null_space_tolerance = 1e-5;
constexpr Eigen::Index rows_in_cache = 512;  // reflections go through all rows once for each column

/// Upper triangle of A, min(rows, cols) x cols.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd A) {
    const Eigen::Index height = std::min(A.rows(), A.cols());
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(A);
    return A.topRows(height).triangularView<Eigen::Upper>();
}

/// Triangle of [W Y] of some rows of one joint. A joint does not feel the links before it: its columns of zeros stay
/// out.
Eigen::MatrixXd triangle_of(const Eigen::Ref<const Eigen::MatrixXd>& W, const Eigen::Ref<const Eigen::VectorXd>& Y) {
    std::vector<Eigen::Index> felt;
    for (Eigen::Index c = 0; c < W.cols(); ++c) {
        if (!W.col(c).isZero(0.0)) {
            felt.push_back(c);
        }
    }
    const Eigen::Index columns = static_cast<Eigen::Index>(felt.size()) + 1;
    Eigen::MatrixXd small(0, columns);
    for (Eigen::Index first = 0; first < W.rows(); first += rows_in_cache) {
        const Eigen::Index count = std::min(rows_in_cache, W.rows() - first);
        Eigen::MatrixXd A(small.rows() + count, columns);
        A.topRows(small.rows()) = small;
        for (Eigen::Index c = 0; c + 1 < columns; ++c) {
            A.col(c).tail(count) = W.col(felt[static_cast<std::size_t>(c)]).segment(first, count);
        }
        A.col(columns - 1).tail(count) = Y.segment(first, count);
        small = triangle_of(std::move(A));
    }

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

joint_triangles::joint_triangles(int joints, int columns)
    : triangles_(static_cast<std::size_t>(joints), Eigen::MatrixXd::Zero(columns + 1, columns + 1)),
      rows_(static_cast<std::size_t>(joints), 0) {}

void joint_triangles::add(std::size_t joint, const Eigen::Ref<const Eigen::MatrixXd>& W,
                          const Eigen::Ref<const Eigen::VectorXd>& Y) {
    triangles_[joint] = combine(triangles_[joint], triangle_of(W, Y));
    rows_[joint] += W.rows();
}

Eigen::Index joint_triangles::rows() const {
    return std::accumulate(rows_.begin(), rows_.end(), Eigen::Index{0});
}

bool joint_triangles::finite() const {
    return std::all_of(triangles_.begin(), triangles_.end(), [](const Eigen::MatrixXd& T) { return T.allFinite(); });
}

double joint_triangles::residual_square(int joint, const Eigen::VectorXd& chi) const {
    const Eigen::Index b = columns();
    return (of(joint).col(b) - of(joint).leftCols(b) * chi).squaredNorm();
}

double joint_triangles::torque_square(int joint) const {
    return of(joint).col(columns()).squaredNorm();
}

joint_triangles joint_triangles::with_columns(const std::vector<int>& kept) const {
    joint_triangles reduced(joints(), static_cast<int>(kept.size()));
    for (std::size_t j = 0; j < triangles_.size(); ++j) {
        reduced.add(j, triangles_[j](Eigen::all, kept), triangles_[j].col(columns()));
    }
    reduced.rows_ = rows_;
    return reduced;
}

joint_triangles triangles_of(const observation& rows) {
    joint_triangles joints(rows.dof, rows.n_base);
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            joints.add(j, block.W[j], block.Y[j]);
        }
    }
    return joints;
}

stacked_qr factor(const joint_triangles& joints, const std::vector<double>& joint_weight) {
    const Eigen::Index b = joints.columns();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(b + 1, b + 1);
    stacked_qr qr;
    for (int j = 0; j < joints.joints(); ++j) {
        const Eigen::MatrixXd joint = joint_weight[static_cast<std::size_t>(j)] * joints.of(j);
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

stacked_qr factor(const observation& rows, const joint_series& weights) {
    joint_triangles joints(static_cast<int>(weights.size()), rows.n_base);
    for (std::size_t j = 0; j < weights.size(); ++j) {
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            const auto weight = weights[j][i].asDiagonal();
            joints.add(j, weight * rows.blocks[i].W[j], weight * rows.blocks[i].Y[j]);
        }
    }
    return factor(joints, std::vector<double>(weights.size(), 1.0));
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
