#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "idim/periodic.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// The rows that stand at one sample.
struct sample_rows {
    std::vector<Eigen::Index> joints;
    std::vector<Eigen::Index> rows;  ///< of each joint, its row there
};

std::vector<sample_rows> samples_of(const observation_block& block) {
    std::vector<sample_rows> samples(static_cast<std::size_t>(block.t.size()));
    for (std::size_t j = 0; j < block.kept.size(); ++j) {
        for (std::size_t k = 0; k < block.kept[j].size(); ++k) {
            sample_rows& at = samples[static_cast<std::size_t>(block.kept[j][k])];
            at.joints.push_back(static_cast<Eigen::Index>(j));
            at.rows.push_back(static_cast<Eigen::Index>(k));
        }
    }
    return samples;
}

void whiten(observation_block& block, const torque_scatter& scatter) {
    const Eigen::Index columns = block.W.front().cols();
    const std::vector<sample_rows> samples = samples_of(block);
    const auto periods = static_cast<double>(scatter.deviations.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const sample_rows& at = samples[k];
        const auto count = static_cast<Eigen::Index>(at.joints.size());
        Eigen::MatrixXd A(count, columns + 1);
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto j = static_cast<std::size_t>(at.joints[i]);
            A.row(i) << block.W[j].row(at.rows[i]), block.Y[j][at.rows[i]];
        }
        const Eigen::MatrixXd covariance = scatter.covariance[k](at.joints, at.joints) / periods;
        A = covariance.llt().matrixL().solve(A).eval();
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto j = static_cast<std::size_t>(at.joints[i]);
            block.W[j].row(at.rows[i]) = A.row(i).head(columns);
            block.Y[j][at.rows[i]] = A(i, columns);
        }
    }
}

std::vector<double> ones(int joints) {
    return std::vector<double>(static_cast<std::size_t>(joints), 1.0);
}

/// The torques of `rows` without the regressor: in log i the deviation of its period p, in the other logs zero.
observation deviated(const observation& rows, const std::vector<torque_scatter>& scatter, std::size_t log,
                     std::size_t p) {
    observation torques = rows;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        observation_block& block = torques.blocks[i];
        for (std::size_t j = 0; j < block.Y.size(); ++j) {
            block.W[j].resize(block.Y[j].size(), 0);
            block.Y[j].setZero();
            if (i == log) {
                block.Y[j] = scatter[i].deviations[p](block.kept[j], static_cast<Eigen::Index>(j));
            }
        }
    }
    return whiten(std::move(torques), scatter);
}

/// W' Y, W of one and Y of the other.
Eigen::VectorXd normal_side(const observation& regressor, const observation& torques) {
    Eigen::VectorXd side = Eigen::VectorXd::Zero(regressor.n_base);
    for (std::size_t i = 0; i < regressor.blocks.size(); ++i) {
        for (std::size_t j = 0; j < regressor.blocks[i].W.size(); ++j) {
            side += regressor.blocks[i].W[j].transpose() * torques.blocks[i].Y[j];
        }
    }
    return side;
}

}  // namespace

observation whiten(observation rows, const std::vector<torque_scatter>& scatter) {
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        whiten(rows.blocks[i], scatter[i]);
    }
    return rows;
}

void restore_units(const observation& rows, estimate& fit) {
    fit.residual = errors(rows, fit.chi);
    fit.joint_deviation = joint_deviations(rows, residuals(rows, fit.chi),
                                           factor(rows, uniform_weights(rows, ones(rows.dof))).parameter_share());
}

estimate fit_whitened(const observation& rows, const observation& whitened) {
    estimate fit = weighted_fit(whitened, ones(rows.dof));
    if (fit.chi.size() > 0) {
        restore_units(rows, fit);
    }
    return fit;
}

Eigen::VectorXd scatter_deviations(const observation& rows, const std::vector<torque_scatter>& scatter) {
    const observation whitened = whiten(rows, scatter);
    const Eigen::MatrixXd root = factor(whitened, uniform_weights(rows, ones(rows.dof))).inverse();
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(rows.n_base);
    for (std::size_t i = 0; i < scatter.size(); ++i) {
        const auto periods = static_cast<double>(scatter[i].deviations.size());
        for (std::size_t p = 0; p < scatter[i].deviations.size(); ++p) {
            const Eigen::VectorXd side = normal_side(whitened, deviated(rows, scatter, i, p));
            variance += (root * (root.transpose() * side)).cwiseAbs2() / (periods * (periods - 1.0));
        }
    }
    return variance.cwiseSqrt();
}

}  // namespace idim
