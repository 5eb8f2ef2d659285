#include "idim/excitation_quality.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "excitation/sampled_model.hpp"

namespace idim {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Squares of what is below it are lost in the Gram matrix.
constexpr double smallest_ratio = 1e-13;

/// The triangle of the rows, b x b.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& W, Eigen::Index dof) {
    const Eigen::Index b = W.cols() / dof;
    Eigen::MatrixXd stacked(W.rows() * dof, b);
    for (Eigen::Index i = 0; i < dof; ++i) {
        stacked.middleRows(i * W.rows(), W.rows()) = W.middleCols(i * b, b);
    }
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stacked);
    return qr.matrixQR().topRows(b).triangularView<Eigen::Upper>();
}

double ratio(const Eigen::VectorXd& singular_values) {
    const double smallest = singular_values.minCoeff();
    const double largest = singular_values.maxCoeff();
    return smallest > smallest_ratio * largest ? largest / smallest : infinite;
}

}  // namespace

double excitation_quality::torque(const Eigen::VectorXd& chi) const {
    return std::sqrt(chi.dot(information * chi));
}

excitation_quality judge_excitation(const idim_model_interface& model, const motion_samples& motion) {
    const Eigen::Index b = model.n_base;
    const auto count = static_cast<double>(motion.t.size());
    excitation_quality quality{infinite,
                               infinite,
                               -infinite,
                               Eigen::VectorXd::Constant(b, infinite),
                               Eigen::VectorXd::Zero(b),
                               Eigen::MatrixXd::Zero(b, b)};
    const Eigen::MatrixXd W = sampled_regressor(model, motion);
    if (!W.allFinite() || W.rows() * model.dof < b) {
        return quality;
    }
    const Eigen::MatrixXd R = triangle_of(W, model.dof);
    quality.information = R.transpose() * R / count;
    const Eigen::VectorXd norm = R.colwise().norm();
    if (norm.minCoeff() == 0.0) {
        return quality;
    }
    const Eigen::MatrixXd scaled = R * norm.cwiseInverse().asDiagonal();
    quality.condition_number = ratio(Eigen::JacobiSVD<Eigen::MatrixXd>(R).singularValues());
    quality.scaled_condition_number = ratio(Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues());
    if (std::isfinite(quality.scaled_condition_number)) {
        const Eigen::MatrixXd inverse = scaled.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(b, b));
        quality.inflation = inverse.rowwise().norm();
        quality.independent_torque = norm.cwiseQuotient(quality.inflation) / std::sqrt(count);
        quality.log_determinant =
            2.0 * R.diagonal().array().abs().log().sum() - static_cast<double>(b) * std::log(count);
    }
    return quality;
}

excitation_quality judge_excitation(const idim_model_interface& model, const fourier_series& series) {
    constexpr Eigen::Index least_samples = 1000;
    return judge_excitation(model, sample_period(series, samples_of_period(series, least_samples)));
}

}  // namespace idim
