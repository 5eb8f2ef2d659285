#include "row_source.hpp"

#include <algorithm>
#include <utility>

#include "weighted_fit.hpp"

namespace idim {

std::pair<Eigen::Index, Eigen::Index> row_part::rows_of(std::size_t joint) const {
    const std::vector<Eigen::Index>& kept = block.kept[joint];
    const auto from = std::lower_bound(kept.begin(), kept.end(), first);
    const auto to = std::lower_bound(from, kept.end(), first + count);
    return {from - kept.begin(), to - from};
}

Eigen::Index row_source::rows() const {
    Eigen::Index count = 0;
    for (int joint = 0; joint < dof(); ++joint) {
        count += rows(joint);
    }
    return count;
}

void resident_rows::visit(Eigen::Index /*margin*/, const std::function<void(const row_part&)>& use) const {
    for (const observation_block& block : rows_.blocks) {
        use({block, 0, block.t.size(), block.t.size(), true});
    }
}

std::unique_ptr<series_source> resident_rows::residual(const Eigen::VectorXd& chi,
                                                       const std::vector<double>& joint_weight) const {
    return std::make_unique<resident_series>(rows_, scaled(residuals(rows_, chi), joint_weight));
}

joint_triangles triangles_of(const row_source& rows) {
    joint_triangles joints(rows.dof(), rows.n_base());
    rows.visit(0, [&](const row_part& part) {
        for (std::size_t j = 0; j < part.block.W.size(); ++j) {
            const auto [first, count] = part.rows_of(j);
            joints.add(j, part.block.W[j].middleRows(first, count), part.block.Y[j].segment(first, count));
        }
    });
    return joints;
}

resident_series::resident_series(const observation& rows, const joint_series& series) : logs_(rows.blocks.size()) {
    for (std::size_t i = 0; i < logs_.size(); ++i) {
        for (std::size_t j = 0; j < series.size(); ++j) {
            const Eigen::VectorXd ones = Eigen::VectorXd::Ones(series[j][i].size());
            logs_[i].push_back({on_grid(rows.blocks[i], j, series[j][i]), on_grid(rows.blocks[i], j, ones)});
        }
    }
}

void resident_series::visit(const std::function<void(const std::vector<gapped_series>&, bool)>& use) const {
    for (const std::vector<gapped_series>& joints : logs_) {
        use(joints, true);
    }
}

Eigen::MatrixXd on_grid(const observation_block& block, std::size_t joint, const Eigen::MatrixXd& values) {
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(block.t.size(), values.cols());
    spread(block.kept[joint], Eigen::all) = values;
    return spread;
}

}  // namespace idim
