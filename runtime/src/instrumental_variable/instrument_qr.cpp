#include "instrumental_variable/instrument_qr.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>

namespace idim {

namespace {

/// The rows of [V W] with the torque.
observation side_by_side(const observation& rows, const observation& instruments) {
    observation both;
    both.dof = rows.dof;
    both.n_base = 2 * rows.n_base;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        const observation_block& block = rows.blocks[i];
        observation_block joined{block.file, block.rate, block.t, block.kept, {}, block.Y};
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            Eigen::MatrixXd VW(block.W[j].rows(), both.n_base);
            VW << instruments.blocks[i].W[j], block.W[j];
            joined.W.push_back(std::move(VW));
        }
        both.blocks.push_back(std::move(joined));
    }
    return both;
}

/// Rank of a square triangle with scaled columns.
rank_report rank_of(const Eigen::MatrixXd& R, const Eigen::VectorXd& column_norm) {
    stacked_qr part;
    part.R = R;
    part.column_norm = column_norm;
    return examine(part);
}

}  // namespace

double instrument_qr::first_stage(Eigen::Index rows) const {
    const double square = smallest_cosine * smallest_cosine;
    const double rest = 1.0 - square;
    return rest > 0.0 ? static_cast<double>(rows) * square / rest : std::numeric_limits<double>::infinity();
}

bool instrument_qr::full_rank() const {
    const auto b = static_cast<int>(S.rows());
    return regressor.rank == b && instruments.rank == b && smallest_cosine > 0.0;
}

Eigen::VectorXd instrument_qr::solve() const {
    return S.partialPivLu().solve(z).cwiseQuotient(column_norm);
}

Eigen::MatrixXd instrument_qr::instrument_inverse() const {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(R_V.rows(), R_V.cols());
    return instrument_norm.cwiseInverse().asDiagonal() * R_V.triangularView<Eigen::Upper>().solve(identity);
}

Eigen::MatrixXd instrument_qr::to_parameters() const {
    return column_norm.cwiseInverse().asDiagonal() * S.inverse();
}

std::vector<double> instrument_qr::parameter_share() const {
    std::vector<double> share;
    for (const Eigen::MatrixXd& T : joint_triangles) {
        share.push_back(R_V.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(T).squaredNorm());
    }
    return share;
}

instrument_qr factor(const observation& rows, const observation& instruments, const std::vector<double>& joint_weight) {
    const observation both = side_by_side(rows, instruments);
    const stacked_qr all = factor(triangles_of(both), joint_weight);
    const Eigen::Index b = rows.n_base;
    instrument_qr result;
    result.R_V = all.R.topLeftCorner(b, b);
    result.S = all.R.topRightCorner(b, b);
    result.z = all.z.head(b);
    result.instrument_norm = all.column_norm.head(b);
    result.column_norm = all.column_norm.tail(b);
    for (const Eigen::MatrixXd& T : all.joints) {
        // Rows below the b-th are zero in the columns of V: the triangle of [V W] begins with that of V.
        result.joint_triangles.emplace_back(T.topLeftCorner(b, b));
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all.R.rightCols(b));
    const Eigen::MatrixXd R_W = qr.matrixQR().topRows(b).triangularView<Eigen::Upper>();
    result.regressor = rank_of(R_W, result.column_norm);
    result.instruments = rank_of(result.R_V, result.instrument_norm);
    if (result.regressor.rank == b && result.instruments.rank == b) {
        const Eigen::MatrixXd product = R_W.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(result.S);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(product, Eigen::ComputeFullV);
        result.smallest_cosine = svd.singularValues()[b - 1];
        const Eigen::VectorXd direction = R_W.triangularView<Eigen::Upper>().solve(svd.matrixV().col(b - 1));
        direction.cwiseAbs().maxCoeff(&result.least_explained);
    }
    return result;
}

}  // namespace idim
