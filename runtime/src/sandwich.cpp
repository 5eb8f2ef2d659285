#include "sandwich.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "idim/autocorrelation.hpp"

namespace idim {

namespace {

constexpr int bias_corrections = 2;

// All of this works on the uniform grid of the samples of every block, with zeros where rows were left out: the noise
// goes on through a gap, what stands on its two sides stays as correlated as its distance in time says, and the rows of
// different joints at one instant stand side by side.

/// Orthonormal basis of the weighted W, W R^-1, [joint][block] of samples x b.
using joint_basis = std::vector<std::vector<Eigen::MatrixXd>>;

/// Residuals, [joint][block].
using grid_series = std::vector<std::vector<gapped_series>>;

/// Rows of a joint at their places among the samples of the block, zeros elsewhere.
Eigen::MatrixXd on_grid(const observation_block& block, std::size_t joint, const Eigen::MatrixXd& values) {
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(block.t.size(), values.cols());
    spread(block.kept[joint], Eigen::all) = values;
    return spread;
}

grid_series on_grid(const observation& rows, const joint_series& series) {
    grid_series spread(series.size());
    for (std::size_t j = 0; j < series.size(); ++j) {
        for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
            const Eigen::VectorXd ones = Eigen::VectorXd::Ones(series[j][i].size());
            spread[j].push_back({on_grid(rows.blocks[i], j, series[j][i]), on_grid(rows.blocks[i], j, ones)});
        }
    }
    return spread;
}

joint_basis basis_of(const observation& rows, const std::vector<double>& joint_weight, const Eigen::MatrixXd& inverse) {
    joint_basis basis(joint_weight.size());
    for (std::size_t j = 0; j < joint_weight.size(); ++j) {
        for (const observation_block& block : rows.blocks) {
            basis[j].push_back(on_grid(block, j, joint_weight[j] * (block.W[j] * inverse)));
        }
    }
    return basis;
}

/// V with M = VV' of a positive semi-definite M, eigenvalues that rounding made negative taken as zero.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& M) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(M);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// Sums over the blocks of one joint that the model of its noise gives: Q' Gamma Q, and tr(Q' D_l P Gamma Q) at lags
/// 0..lags with D_l the symmetric shift by l and P the rows present.
struct model_sums {
    Eigen::MatrixXd meat;
    Eigen::VectorXd shifted;
};

model_sums sums_of(const std::vector<Eigen::MatrixXd>& Q, const std::vector<gapped_series>& residual,
                   const autoregression& model, Eigen::Index lags) {
    const Eigen::Index b = Q.front().cols();
    model_sums sums{Eigen::MatrixXd::Zero(b, b), Eigen::VectorXd::Zero(lags + 1)};
    for (std::size_t i = 0; i < Q.size(); ++i) {
        const Eigen::MatrixXd Z = innovation_responses(model, Q[i], model.memory(Q[i].rows()));
        sums.meat.selfadjointView<Eigen::Lower>().rankUpdate(Z.transpose(), model.innovation);
        const Eigen::MatrixXd G = residual[i].present.asDiagonal() * covariance_times(model, Z, Q[i].rows());
        sums.shifted += 0.25 * (lagged_products(Q[i] + G, lags) - lagged_products(Q[i] - G, lags));
    }
    sums.meat = Eigen::MatrixXd(sums.meat.selfadjointView<Eigen::Lower>());
    return sums;
}

/// Models of the noise from the residual's autocovariance, corrected for what the fit has taken away. With
/// e = (P - QQ') rho and S = sum_j Q_j' Gamma_j Q_j, the products of joint j at lag l have the expectation
///     pairs(l) gamma_j(l) - 2 tr(Q_j' D_l P_j Gamma_j Q_j) + tr(D_l Q_j S Q_j').
std::vector<autoregression> noise_models(const joint_basis& Q, const grid_series& residual) {
    const std::size_t joints = residual.size();
    const Eigen::Index b = Q.front().front().cols();
    std::vector<Eigen::VectorXd> raw;
    std::vector<autoregression> models;
    for (const std::vector<gapped_series>& segments : residual) {
        raw.push_back(autocovariance(segments, highest_order(segments)));
        models.push_back(fit_autoregression(raw.back(), samples_of(segments)));
    }
    for (int pass = 0; pass < bias_corrections; ++pass) {
        std::vector<Eigen::VectorXd> shifted;
        Eigen::MatrixXd S = Eigen::MatrixXd::Zero(b, b);
        for (std::size_t j = 0; j < joints; ++j) {
            const model_sums sums = sums_of(Q[j], residual[j], models[j], raw[j].size() - 1);
            S += sums.meat;
            shifted.push_back(sums.shifted);
        }
        const Eigen::MatrixXd root = root_of(S);
        for (std::size_t j = 0; j < joints; ++j) {
            Eigen::VectorXd taken = 2.0 * shifted[j];
            for (const Eigen::MatrixXd& block : Q[j]) {
                taken -= lagged_products(block * root, raw[j].size() - 1);
            }
            // No pairs at all: nothing was taken either.
            const Eigen::VectorXd pairs = lagged_pairs(residual[j], raw[j].size() - 1).cwiseMax(1.0);
            models[j] = fit_autoregression(raw[j] + taken.cwiseQuotient(pairs), samples_of(residual[j]));
        }
    }
    return models;
}

/// Correlation of the innovations of every two joints, over the samples that both have [n x n].
Eigen::MatrixXd innovation_correlation(const std::vector<autoregression>& models, const grid_series& residual) {
    const auto n = static_cast<Eigen::Index>(models.size());
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd power = products;  // of the row's joint, where the column's is present too
    for (std::size_t i = 0; i < residual.front().size(); ++i) {
        Eigen::MatrixXd eps = Eigen::MatrixXd::Zero(residual.front()[i].value.size(), n);
        Eigen::MatrixXd present = eps;
        for (Eigen::Index j = 0; j < n; ++j) {
            const Eigen::VectorXd known = innovations(models[j], residual[j][i]);
            eps.col(j).tail(known.size()) = known;
            present.col(j).tail(known.size()) = residual[j][i].present.tail(known.size());
        }
        products += eps.transpose() * eps;
        power += eps.cwiseAbs2().transpose() * present;
    }
    const Eigen::ArrayXXd norm = (power.array() * power.transpose().array()).sqrt();
    Eigen::MatrixXd correlation = (norm > 0.0).select(products.array() / norm, 0.0);
    correlation.diagonal().setOnes();
    return correlation;
}

/// Root of the covariance of the joints' innovations: diagonal from the models, correlation from the innovations
/// themselves.
Eigen::MatrixXd innovation_root(const std::vector<autoregression>& models, const grid_series& residual) {
    Eigen::VectorXd deviation(static_cast<Eigen::Index>(models.size()));
    for (Eigen::Index j = 0; j < deviation.size(); ++j) {
        deviation[j] = std::sqrt(models[j].innovation);
    }
    return root_of(deviation.asDiagonal() * innovation_correlation(models, residual) * deviation.asDiagonal());
}

/// Adds sum_m (sum_j z_jm root_ji) (...)' of one block: the variance of Q' rho that the innovations of all joints make
/// together.
void add_meat(const joint_basis& Q, std::size_t block, const std::vector<autoregression>& models,
              const Eigen::MatrixXd& root, Eigen::MatrixXd& meat) {
    const Eigen::Index samples = Q.front()[block].rows();
    Eigen::Index tail = 0;
    for (const autoregression& model : models) {
        tail = std::max(tail, model.memory(samples));
    }
    std::vector<Eigen::MatrixXd> responses;
    for (std::size_t j = 0; j < models.size(); ++j) {
        responses.push_back(innovation_responses(models[j], Q[j][block], tail));
    }
    for (Eigen::Index i = 0; i < root.cols(); ++i) {
        Eigen::MatrixXd U = Eigen::MatrixXd::Zero(samples + tail, meat.cols());
        for (std::size_t j = 0; j < models.size(); ++j) {
            U += root(static_cast<Eigen::Index>(j), i) * responses[j];
        }
        meat.selfadjointView<Eigen::Lower>().rankUpdate(U.transpose());
    }
}

}  // namespace

sandwich robust_covariance(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                           const joint_series& residual) {
    const Eigen::MatrixXd inverse = qr.inverse();
    return robust_covariance(rows, joint_weight, inverse, inverse, residual);
}

sandwich robust_covariance(const observation& instruments, const std::vector<double>& joint_weight,
                           const Eigen::MatrixXd& instrument_inverse, const Eigen::MatrixXd& to_parameters,
                           const joint_series& residual) {
    const joint_basis Q = basis_of(instruments, joint_weight, instrument_inverse);
    const grid_series series = on_grid(instruments, residual);
    const std::vector<autoregression> models = noise_models(Q, series);
    const Eigen::MatrixXd root = innovation_root(models, series);
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(instruments.n_base, instruments.n_base);
    for (std::size_t i = 0; i < instruments.blocks.size(); ++i) {
        add_meat(Q, i, models, root, meat);
    }
    const Eigen::MatrixXd half = to_parameters * root_of(meat.selfadjointView<Eigen::Lower>());
    sandwich result;
    result.covariance = half * half.transpose();
    for (std::size_t j = 0; j < models.size(); ++j) {
        result.correlation_length.push_back(models[j].correlation_length(samples_of(series[j])));
    }
    return result;
}

}  // namespace idim
