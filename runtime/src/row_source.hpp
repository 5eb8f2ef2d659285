#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "idim/autocorrelation.hpp"
#include "idim/observation.hpp"
#include "stacked_qr.hpp"

namespace idim {

/// A number for every row, on the uniform grid of the samples: zeros where rows were left out.
class series_source {
  public:
    virtual ~series_source() = default;

    /// Calls `use` with successive pieces of all joints, in the order of the logs and of time; `begins` with the first
    /// of a log.
    virtual void visit(const std::function<void(const std::vector<gapped_series>&, bool begins)>& use) const = 0;
};

/// Successive rows of one log with some of its rows before and behind them, for what is correlated in time.
struct row_part {
    const observation_block& block;  ///< the rows with those around them
    Eigen::Index first = 0;          ///< sample of `block` where the part begins
    Eigen::Index count = 0;          ///< samples of the part
    Eigen::Index reach = 0;          ///< samples beyond which nothing counts as correlated: the log's, or fewer
    bool begins_log = true;          ///< nothing stands before `block`

    /// Rows of a joint within the part: where they begin in block.W[joint], and how many.
    std::pair<Eigen::Index, Eigen::Index> rows_of(std::size_t joint) const;
};

/// The rows of an identification, part by part in the order of the logs and of time, however often they are asked for.
/// What is computed from them needs no more memory than a part.
class row_source {
  public:
    virtual ~row_source() = default;

    virtual int dof() const = 0;
    virtual int n_base() const = 0;
    virtual std::size_t logs() const = 0;
    /// Rows of a joint over all logs.
    virtual Eigen::Index rows(int joint) const = 0;
    /// Calls `use` with every part, `margin` samples around it as far as the log has them, or more.
    virtual void visit(Eigen::Index margin, const std::function<void(const row_part&)>& use) const = 0;

    /// Y - W chi, the rows of each joint multiplied by its weight. The source must outlive it.
    virtual std::unique_ptr<series_source> residual(const Eigen::VectorXd& chi,
                                                    const std::vector<double>& joint_weight) const = 0;

    /// Rows of all joints over all logs.
    Eigen::Index rows() const;
};

/// Their triangles, in one pass.
joint_triangles triangles_of(const row_source& rows);

/// Rows that are in memory: every log is one part.
class resident_rows : public row_source {
  public:
    /// `rows` must outlive it.
    explicit resident_rows(const observation& rows) : rows_(rows) {}

    int dof() const override { return rows_.dof; }
    int n_base() const override { return rows_.n_base; }
    std::size_t logs() const override { return rows_.blocks.size(); }
    Eigen::Index rows(int joint) const override { return rows_.rows(joint); }
    void visit(Eigen::Index margin, const std::function<void(const row_part&)>& use) const override;
    std::unique_ptr<series_source> residual(const Eigen::VectorXd& chi,
                                            const std::vector<double>& joint_weight) const override;
    using row_source::rows;

  private:
    const observation& rows_;
};

/// A series in memory: every log is one piece.
class resident_series : public series_source {
  public:
    resident_series(const observation& rows, const joint_series& series);
    void visit(const std::function<void(const std::vector<gapped_series>&, bool)>& use) const override;

  private:
    std::vector<std::vector<gapped_series>> logs_;  ///< [log][joint]
};

/// Rows of a joint at their places among the samples of the block, zeros elsewhere.
Eigen::MatrixXd on_grid(const observation_block& block, std::size_t joint, const Eigen::MatrixXd& values);

}  // namespace idim
