#pragma once

#include <string>

#include "idim/filtered_samples.hpp"
#include "idim/second_order_sections.hpp"

namespace idim {

/// How long a uniform log is.
struct sampled_span {
    std::string file;
    Eigen::Index samples = 0;
    double rate = 0.0;  ///< [Hz]
};

/// The zero-phase low-pass and the differences that make filtered_samples of a uniform log, or of a part of it.
class motion_filter {
  public:
    /// Throws input_error if the log is shorter than the filter needs, naming both lengths, or for a cut-off that is
    /// not below half the rate.
    motion_filter(const sampled_span& log, const filter_choice& choice);

    /// Samples that are lost at both ends of a log.
    Eigen::Index edge() const { return edge_; }
    /// Samples around a part with which it is filtered as the whole log, to rounding; at least edge().
    Eigen::Index reach() const { return reach_; }
    double rate() const { return rate_; }

    /// Samples first..first+n-1 of `uniform`, at least edge() of its samples on both sides.
    filtered_samples apply(const log& uniform, Eigen::Index first, Eigen::Index n) const;

  private:
    double rate_;
    second_order_sections filter_;  ///< of order 0 if positions are not filtered
    Eigen::Index edge_ = 0;
    Eigen::Index reach_ = 0;
};

/// Throws input_error if filtered samples of a log are fewer than the decimation needs.
void check_decimation(const std::string& file, Eigen::Index samples, const filter_choice& choice);

}  // namespace idim
