#include "sandwich.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "idim/autocorrelation.hpp"

namespace idim {

namespace {

constexpr int bias_corrections = 2;

/// Orthonormal basis of the weighted W, W R^-1, [joint][block] of rows x b.
using joint_basis = std::vector<std::vector<Eigen::MatrixXd>>;

Eigen::Index size_of(const std::vector<Eigen::VectorXd>& segments) {
    Eigen::Index samples = 0;
    for (const Eigen::VectorXd& segment : segments) {
        samples += segment.size();
    }
    return samples;
}

joint_basis basis_of(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr) {
    const Eigen::MatrixXd inverse = qr.inverse();
    joint_basis basis(joint_weight.size());
    for (std::size_t j = 0; j < joint_weight.size(); ++j) {
        for (const observation_block& block : rows.blocks) {
            basis[j].push_back(joint_weight[j] * (block.W[j] * inverse));
        }
    }
    return basis;
}

/// V with M = VV' of a positive semi-definite M, eigenvalues that rounding made negative taken as zero.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& M) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(M);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// Sums over the blocks of one joint that the model of its noise gives: Q' Gamma Q, and tr(Q' D_l Gamma Q) at lags
/// 0..lags with D_l the symmetric shift by l. Both follow from the responses Z, the second as their lagged products.
struct model_sums {
    Eigen::MatrixXd meat;
    Eigen::VectorXd shifted;
};

model_sums sums_of(const std::vector<Eigen::MatrixXd>& Q, const autoregression& model, Eigen::Index lags) {
    const Eigen::Index b = Q.front().cols();
    model_sums sums{Eigen::MatrixXd::Zero(b, b), Eigen::VectorXd::Zero(lags + 1)};
    for (const Eigen::MatrixXd& block : Q) {
        const Eigen::MatrixXd Z = innovation_responses(model, block, model.memory(block.rows()));
        sums.meat.selfadjointView<Eigen::Lower>().rankUpdate(Z.transpose(), model.innovation);
        sums.shifted += model.innovation * lagged_products(Z, lags);
    }
    sums.meat = Eigen::MatrixXd(sums.meat.selfadjointView<Eigen::Lower>());
    return sums;
}

/// Pairs (k, k + l) that the segments hold at lag l, for lags 0..lags.
Eigen::VectorXd pairs(const std::vector<Eigen::VectorXd>& segments, Eigen::Index lags) {
    Eigen::VectorXd count = Eigen::VectorXd::Zero(lags + 1);
    for (const Eigen::VectorXd& segment : segments) {
        for (Eigen::Index l = 0; l <= std::min(lags, segment.size()); ++l) {
            count[l] += static_cast<double>(segment.size() - l);
        }
    }
    return count;
}

/// Models of the noise from the residual's autocovariance, corrected for what the fit has taken away. With
/// e = (1 - QQ') rho and S = sum_j Q_j' Gamma_j Q_j, the products of joint j at lag l have the expectation
///     pairs(l) gamma_j(l) - 2 tr(Q_j' D_l Gamma_j Q_j) + tr(D_l Q_j S Q_j').
std::vector<autoregression> noise_models(const joint_basis& Q, const joint_series& residual) {
    const std::size_t joints = residual.size();
    const Eigen::Index b = Q.front().front().cols();
    std::vector<Eigen::VectorXd> raw;
    std::vector<autoregression> models;
    for (const std::vector<Eigen::VectorXd>& segments : residual) {
        raw.push_back(autocovariance(segments, highest_order(segments)));
        models.push_back(fit_autoregression(raw.back(), size_of(segments)));
    }
    for (int pass = 0; pass < bias_corrections; ++pass) {
        std::vector<Eigen::VectorXd> shifted;
        Eigen::MatrixXd S = Eigen::MatrixXd::Zero(b, b);
        for (std::size_t j = 0; j < joints; ++j) {
            const model_sums sums = sums_of(Q[j], models[j], raw[j].size() - 1);
            S += sums.meat;
            shifted.push_back(sums.shifted);
        }
        const Eigen::MatrixXd root = root_of(S);
        for (std::size_t j = 0; j < joints; ++j) {
            const Eigen::Index samples = size_of(residual[j]);
            Eigen::VectorXd sum = static_cast<double>(samples) * raw[j] + 2.0 * shifted[j];
            for (const Eigen::MatrixXd& block : Q[j]) {
                sum -= lagged_products(block * root, raw[j].size() - 1);
            }
            if (samples > 0) {
                models[j] = fit_autoregression(sum.cwiseQuotient(pairs(residual[j], raw[j].size() - 1)), samples);
            }
        }
    }
    return models;
}

bool same_rows(const joint_series& residual) {
    for (const std::vector<Eigen::VectorXd>& segments : residual) {
        for (std::size_t i = 0; i < segments.size(); ++i) {
            if (segments[i].size() != residual.front()[i].size()) {
                return false;
            }
        }
    }
    return true;
}

/// Root of the covariance of the joints' innovations: diagonal from the models, correlation from the innovations
/// themselves.
Eigen::MatrixXd innovation_root(const std::vector<autoregression>& models, const joint_series& residual) {
    const Eigen::Index n = static_cast<Eigen::Index>(models.size());
    Eigen::VectorXd deviation(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        deviation[j] = std::sqrt(models[j].innovation);
    }
    if (!same_rows(residual)) {
        return deviation.asDiagonal();
    }
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < residual.front().size(); ++i) {
        std::vector<Eigen::VectorXd> eps;
        Eigen::Index common = residual.front()[i].size();
        for (Eigen::Index j = 0; j < n; ++j) {
            eps.push_back(innovations(models[j], residual[j][i]));
            common = std::min(common, eps.back().size());
        }
        for (Eigen::Index j = 0; j < n; ++j) {
            for (Eigen::Index k = 0; k < n; ++k) {
                products(j, k) += eps[j].tail(common).dot(eps[k].tail(common));
            }
        }
    }
    const Eigen::VectorXd norm = products.diagonal().cwiseSqrt();
    const Eigen::VectorXd scale = (norm.array() > 0.0).select(norm.cwiseInverse(), 0.0);
    Eigen::MatrixXd correlation = scale.asDiagonal() * products * scale.asDiagonal();
    correlation.diagonal().setOnes();
    return root_of(deviation.asDiagonal() * correlation * deviation.asDiagonal());
}

/// Adds sum_m (sum_j z_jm root_ji) (...)' of one block: the variance of Q' rho that the innovations of all joints make
/// together.
void add_meat(const joint_basis& Q, std::size_t block, const std::vector<autoregression>& models,
              const Eigen::MatrixXd& root, Eigen::MatrixXd& meat) {
    Eigen::Index tail = 0;
    Eigen::Index rows = 0;
    for (std::size_t j = 0; j < models.size(); ++j) {
        tail = std::max(tail, models[j].memory(Q[j][block].rows()));
        rows = std::max(rows, Q[j][block].rows());
    }
    std::vector<Eigen::MatrixXd> responses;
    for (std::size_t j = 0; j < models.size(); ++j) {
        responses.push_back(innovation_responses(models[j], Q[j][block], tail));
    }
    for (Eigen::Index i = 0; i < root.cols(); ++i) {
        Eigen::MatrixXd U = Eigen::MatrixXd::Zero(rows + tail, meat.cols());
        for (std::size_t j = 0; j < models.size(); ++j) {
            U.topRows(responses[j].rows()) += root(static_cast<Eigen::Index>(j), i) * responses[j];
        }
        meat.selfadjointView<Eigen::Lower>().rankUpdate(U.transpose());
    }
}

}  // namespace

sandwich robust_covariance(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                           const joint_series& residual) {
    const joint_basis Q = basis_of(rows, joint_weight, qr);
    const std::vector<autoregression> models = noise_models(Q, residual);
    const Eigen::MatrixXd root = innovation_root(models, residual);
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(rows.n_base, rows.n_base);
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        add_meat(Q, i, models, root, meat);
    }
    const Eigen::MatrixXd half = qr.inverse() * root_of(meat.selfadjointView<Eigen::Lower>());
    sandwich result;
    result.covariance = half * half.transpose();
    for (std::size_t j = 0; j < models.size(); ++j) {
        result.correlation_length.push_back(models[j].correlation_length(size_of(residual[j])));
    }
    return result;
}

}  // namespace idim
