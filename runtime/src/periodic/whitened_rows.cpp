#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "periodic/folded_period.hpp"
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

/// The rows of one log with the torques that are the deviation of a period.
observation deviated(const observation& rows, std::size_t log, const Eigen::MatrixXd& deviation) {
    observation torques{{rows.blocks[log]}, rows.dof, rows.n_base};
    observation_block& block = torques.blocks.front();
    for (std::size_t j = 0; j < block.Y.size(); ++j) {
        block.Y[j] = deviation(block.kept[j], static_cast<Eigen::Index>(j));
    }
    return torques;
}

/// W' Y over all rows.
Eigen::VectorXd normal_side(const observation& rows) {
    Eigen::VectorXd side = Eigen::VectorXd::Zero(rows.n_base);
    for (const observation_block& block : rows.blocks) {
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            side += block.W[j].transpose() * block.Y[j];
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
    fit.joint_deviation =
        joint_deviations(rows, residuals(rows, fit.chi), factor(triangles_of(rows), ones(rows.dof)).parameter_share());
}

estimate fit_whitened(const observation& rows, const observation& whitened) {
    estimate fit = weighted_fit(whitened, ones(rows.dof));
    if (fit.chi.size() > 0) {
        restore_units(rows, fit);
    }
    return fit;
}

Eigen::VectorXd scatter_deviations(const observation& rows, const std::vector<torque_scatter>& scatter) {
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(rows.n_base);
    for (std::size_t i = 0; i < scatter.size(); ++i) {
        const std::size_t count = scatter[i].deviations.size();
        const auto periods = static_cast<double>(count);
        std::vector<torque_scatter> weights = scatter;
        for (std::size_t p = 0; p < count; ++p) {
            if (count > 2) {
                weights[i] = without_period(scatter[i], p);
            }
            const observation whitened = whiten(rows, weights);
            const Eigen::MatrixXd root = factor(triangles_of(whitened), ones(rows.dof)).inverse();
            const observation torques = whiten(deviated(rows, i, scatter[i].deviations[p]), {weights[i]});
            variance += (root * (root.transpose() * normal_side(torques))).cwiseAbs2() / (periods * (periods - 1.0));
        }
    }
    return variance.cwiseSqrt();
}

}  // namespace idim
