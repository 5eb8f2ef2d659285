#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace idim {

/// One recorded motion, joint side, SI units, as read from a file: samples in rows, joints in columns (FORMATS.md,
/// "Log"). A matrix that the file does not have is empty (0 x 0).
struct log {
    std::string file;
    Eigen::VectorXd t;     ///< [s], strictly increasing
    Eigen::MatrixXd q;     ///< measured position [rad or m], samples x dof
    Eigen::MatrixXd tau;   ///< torque [N*m or N]; from `tau1..`, or from `v1..` times the drive gain
    Eigen::MatrixXd v;     ///< drive command, if recorded
    Eigen::MatrixXd qr;    ///< reference position
    Eigen::MatrixXd qd;    ///< measured velocity
    Eigen::MatrixXd qdd;   ///< measured acceleration
    Eigen::MatrixXd temp;  ///< temperature [degC]

    Eigen::Index samples() const { return t.size(); }
    /// Duration from the first to the last sample [s].
    double duration() const { return t.size() > 1 ? t[t.size() - 1] - t[0] : 0.0; }
};

/// What a reader must know of the robot to make sense of a log.
struct log_columns {
    std::vector<std::string> joint_names;  ///< `q_<joint name>` is as good as `q1`
    std::vector<double> drive_gain;        ///< [N*m or N per unit of v], 0 where unknown
    bool torque_required = true;           ///< a reference file has none
};

/// Reads a CSV or gzip CSV log. Throws input_error naming file, line and column for: a missing column, too few or too
/// many columns in a row, text or NaN or infinity in a number, time that does not increase, no rows, `v` without a
/// drive gain.
log read_log(const std::string& file, const log_columns& columns);

/// The same block by block, for logs that need not fit into memory.
class log_reader {
  public:
    /// Reads the header. Throws input_error as read_log.
    log_reader(const std::string& file, const log_columns& columns);

    /// The next rows, at most `most` of them; no samples at the end of the file. Throws input_error as read_log.
    log next(Eigen::Index most) { return next_(most); }

  private:
    std::function<log(Eigen::Index)> next_;  ///< holds the open file
};

/// Writes the non-empty columns of a log as CSV, numbers printed so that they read back exactly. Throws input_error if
/// the file cannot be written.
void write_log(const std::string& file, const log& data);

}  // namespace idim
