#include "idim/log_parameters.hpp"

#include <Eigen/QR>

namespace idim {

namespace {

std::vector<int> own_parameters(const idim_model_interface& model) {
    std::vector<int> own;
    for (int k = 0; k < model.n_base && model.parameter_is_per_log != nullptr; ++k) {
        if (model.parameter_is_per_log[k] != 0) {
            own.push_back(k);
        }
    }
    return own;
}

/// Columns of a log among those of with_log_columns.
std::vector<int> columns_of_log(const std::vector<int>& own, int n_base, std::size_t log) {
    std::vector<int> columns = own;
    for (std::size_t i = 0; i < own.size() && log > 0; ++i) {
        columns[i] = n_base + static_cast<int>((log - 1) * own.size() + i);
    }
    return columns;
}

}  // namespace

observation with_log_columns(const idim_model_interface& model, observation rows) {
    const std::vector<int> own = own_parameters(model);
    if (own.empty() || rows.blocks.size() < 2) {
        return rows;
    }
    const int all = model.n_base + static_cast<int>(own.size() * (rows.blocks.size() - 1));
    rows.columns.resize(static_cast<std::size_t>(all));
    for (int k = 0; k < model.n_base; ++k) {
        rows.columns[static_cast<std::size_t>(k)] = {k, -1};
    }
    for (std::size_t l = 0; l < rows.blocks.size(); ++l) {
        const std::vector<int> places = columns_of_log(own, model.n_base, l);
        for (std::size_t i = 0; i < own.size(); ++i) {
            rows.columns[static_cast<std::size_t>(places[i])] = {own[i], static_cast<int>(l)};
        }
        for (Eigen::MatrixXd& W : rows.blocks[l].W) {
            Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(W.rows(), all);
            wide.leftCols(model.n_base) = W;
            for (std::size_t i = 0; i < own.size(); ++i) {
                wide.col(own[i]).setZero();
                wide.col(places[i]) = W.col(own[i]);
            }
            W = std::move(wide);
        }
    }
    rows.n_base = all;
    return rows;
}

Eigen::VectorXd with_log_parameters(const idim_model_interface& model, const observation& rows,
                                    const Eigen::VectorXd& chi) {
    const std::vector<int> own = own_parameters(model);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(rows.n_base);
    all.head(model.n_base) = chi;
    for (const int k : own) {
        all[k] = 0.0;
    }
    for (std::size_t l = 0; l < rows.blocks.size() && !own.empty(); ++l) {
        const std::vector<int> columns = columns_of_log(own, model.n_base, l);
        const observation_block& block = rows.blocks[l];
        Eigen::Index count = 0;
        for (const Eigen::VectorXd& Y : block.Y) {
            count += Y.size();
        }
        Eigen::MatrixXd W(count, static_cast<Eigen::Index>(columns.size()));
        Eigen::VectorXd residual(count);
        Eigen::Index first = 0;
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            const Eigen::Index size = block.Y[j].size();
            W.middleRows(first, size) = block.W[j](Eigen::all, columns);
            residual.segment(first, size) = block.Y[j] - block.W[j] * all;
            first += size;
        }
        const Eigen::VectorXd fitted = W.completeOrthogonalDecomposition().solve(residual);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            all[columns[i]] = fitted[static_cast<Eigen::Index>(i)];
        }
    }
    return all;
}

}  // namespace idim
