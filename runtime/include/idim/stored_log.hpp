#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/log.hpp"

namespace idim {

/// A log that need not fit into memory: read once, block by block, checked as read_log does, and kept on a uniform grid
/// (resample_uniform) in a temporary file. Holds time, position, torque and temperature; memory does not depend on its
/// length.
class stored_log {
  public:
    /// `check` sees every block as it is read and may throw. Throws input_error as read_log, for a single sample, and
    /// where the temporary file cannot be written.
    stored_log(const std::string& file, const log_columns& columns, const std::function<void(const log&)>& check = {});
    stored_log(stored_log&&) noexcept;
    stored_log& operator=(stored_log&&) noexcept;
    ~stored_log();

    const std::string& file() const;
    Eigen::Index samples() const;  ///< of the uniform grid
    double rate() const;           ///< [Hz]
    double start() const;          ///< time of the first sample [s]
    /// Largest less smallest position of each joint as recorded [n].
    Eigen::VectorXd range() const;
    /// Uniform samples first..first+count-1.
    log part(Eigen::Index first, Eigen::Index count) const;

  private:
    struct contents;
    std::unique_ptr<contents> held_;
};

/// choose_filter (filtered_samples.hpp) of stored logs.
filter_choice choose_filter(const std::vector<stored_log>& logs, const filter_request& request);

}  // namespace idim
