#pragma once

#include "row_source.hpp"
#include "streaming/decimated_log.hpp"

namespace idim {

/// The rows of stored logs: computed from the temporary files whenever they are asked for, part by part.
class streamed_rows : public row_source {
  public:
    /// What is given must outlive it. Throws input_error where the model needs the log as a whole (needs_whole_log) or
    /// does not fit the logs.
    streamed_rows(const idim_model_interface& model, const std::vector<stored_log>& logs, const filter_choice& choice);

    int dof() const override { return model_.dof; }
    int n_base() const override { return model_.n_base; }
    std::size_t logs() const override { return logs_.size(); }
    Eigen::Index rows(int joint) const override;
    void visit(Eigen::Index margin, const std::function<void(const row_part&)>& use) const override;
    std::unique_ptr<series_source> residual(const Eigen::VectorXd& chi,
                                            const std::vector<double>& joint_weight) const override;
    using row_source::rows;

    const std::vector<decimated_log>& decimated() const { return logs_; }

  private:
    void visit(const decimated_log& log, Eigen::Index margin, const std::function<void(const row_part&)>& use) const;

    const idim_model_interface& model_;
    std::vector<decimated_log> logs_;
};

}  // namespace idim
