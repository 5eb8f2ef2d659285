#include "excitation/gram_criterion.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace idim {

namespace {

/// Eigenvalues below are rounding.
constexpr double eigenvalue_floor = 1e-14;

/// Value and its derivative by each eigenvalue of S.
double spectral_value(const Eigen::ArrayXd& eigenvalues, double p, Eigen::ArrayXd& slope) {
    const double smallest = eigenvalues.minCoeff();
    const double largest = eigenvalues.maxCoeff();
    const Eigen::ArrayXd up = (eigenvalues / largest).pow(p);
    const Eigen::ArrayXd down = (smallest / eigenvalues).pow(p);
    slope = 0.5 * (up / up.sum() - down / down.sum()) / eigenvalues;
    return 0.5 * (std::log(largest / smallest) + (std::log(up.sum()) + std::log(down.sum())) / p);
}

}  // namespace

gram_value criterion_of(const Eigen::MatrixXd& G, excitation_criterion criterion, double p) {
    // A column that is zero gets a norm that keeps all finite.
    const bool is_scaled = criterion != excitation_criterion::unscaled_condition;
    const Eigen::VectorXd norm =
        is_scaled ? Eigen::VectorXd(G.diagonal().cwiseMax(1e-30).cwiseSqrt()) : Eigen::VectorXd::Ones(G.rows());
    const Eigen::VectorXd inverse = norm.cwiseInverse();
    const Eigen::MatrixXd S = inverse.asDiagonal() * G * inverse.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S);
    const Eigen::ArrayXd values = eigen.eigenvalues().array().max(eigenvalue_floor);
    gram_value result;
    Eigen::ArrayXd slope;
    const auto b = static_cast<double>(G.rows());
    if (criterion != excitation_criterion::information) {
        result.value = spectral_value(values, p, slope);
        result.figure = std::sqrt(values.maxCoeff() / values.minCoeff());
    } else {
        result.figure = values.log().sum() + 2.0 * norm.array().log().sum();
        result.value = -0.5 * result.figure / b;
        slope = -0.5 / (b * values);
    }
    const Eigen::MatrixXd by_S = eigen.eigenvectors() * slope.matrix().asDiagonal() * eigen.eigenvectors().transpose();
    result.derivative = inverse.asDiagonal() * by_S * inverse.asDiagonal();
    // log det G does not change with the scaling of the columns; else S = D G D with D of the diagonal of G.
    if (criterion == excitation_criterion::condition) {
        result.derivative.diagonal() -= (by_S * S).diagonal().cwiseProduct(inverse.cwiseAbs2());
    }
    return result;
}

}  // namespace idim
