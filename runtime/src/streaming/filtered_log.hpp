#pragma once

#include "idim/motion_source.hpp"
#include "motion_filter.hpp"

namespace idim {

/// The filtered samples of a stored log (filter_log), part by part: every part is filtered with so much of the log
/// around it that it comes out as in the whole, to rounding.
// 2026-11-29: instead of a backward pass over a second temporary file, which would give the same bytes: the decimation
// has to filter the regressor, too wide to be stored, and there is one way for both.
class filtered_log : public motion_source {
  public:
    /// `data` must outlive it. Throws input_error as filter_log.
    filtered_log(const stored_log& data, const filter_choice& choice);

    const std::string& file() const override { return data_->file(); }
    double rate() const override { return data_->rate(); }
    Eigen::Index samples() const override { return data_->samples() - 2 * filter_.edge(); }
    filtered_samples part(Eigen::Index first, Eigen::Index count) const override;

  private:
    const stored_log* data_;
    motion_filter filter_;
};

}  // namespace idim
