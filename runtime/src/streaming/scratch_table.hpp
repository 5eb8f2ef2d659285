#pragma once

#include <Eigen/Core>

#include "file_descriptor.hpp"

namespace idim {

/// Rows of numbers in a temporary file (in TMPDIR, /tmp by default) that no one else sees and that is gone with this
/// object: what is read again and again but need not fit into memory.
class scratch_table {
  public:
    /// Throws input_error if the file cannot be made.
    explicit scratch_table(Eigen::Index width);

    Eigen::Index rows() const { return rows_; }
    Eigen::Index width() const { return width_; }
    /// Adds rows [n x width]. Throws input_error if they cannot be written.
    void append(const Eigen::MatrixXd& rows);
    /// Rows first..first+count-1 [count x width].
    Eigen::MatrixXd read(Eigen::Index first, Eigen::Index count) const;

  private:
    file_descriptor file_;
    Eigen::Index width_;
    Eigen::Index rows_ = 0;
};

}  // namespace idim
