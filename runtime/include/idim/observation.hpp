#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"

namespace idim {

/// The rows that one log contributes, per joint: their places among the decimated samples of the log, ascending.
using row_selection = std::vector<std::vector<Eigen::Index>>;

/// The over-determined system Y = W chi + rho of [IV 10-14], kept joint by joint and log by log so that nothing is ever
/// filtered, correlated or split across a seam: rows of joint j stand in blocks[log].joints[j]. Row k of joint j stands
/// at the time t[kept[j][k]]: rows that were left out are gaps in a uniform series, and what is correlated in time
/// counts them.
struct observation_block {
    std::string file;
    double rate = 0.0;               ///< rate of the samples, after decimation [Hz]
    Eigen::VectorXd t;               ///< time of all decimated samples, kept or not [s]
    row_selection kept;              ///< per joint: sample of every row
    std::vector<Eigen::MatrixXd> W;  ///< per joint: rows x b [unit of the torque per unit of the parameter]
    std::vector<Eigen::VectorXd> Y;  ///< per joint: rows [N*m or N]
};

struct observation {
    /// What a column of W belongs to: a base parameter, and where that is each log's own, the log (-1: all).
    struct column {
        int parameter = 0;
        int log = -1;
    };

    std::vector<observation_block> blocks;
    int dof = 0;
    int n_base = 0;                    ///< columns
    std::vector<column> columns = {};  ///< empty: one for each base parameter

    /// Rows of joint j over all blocks.
    Eigen::Index rows(int joint) const;
    /// Rows of all joints over all blocks.
    Eigen::Index rows() const;
    /// Part of the samples of all joints that are no rows, 0 to 1.
    double share_left_out() const;
};

/// Of a column of the rows.
observation::column column_of(const observation& rows, int column);

/// Every one of `samples` for each of `joints` joints.
row_selection all_rows(int joints, Eigen::Index samples);

/// The rows that are fit to identify from: all of joint j but those of its rests, runs of rows whose own decimated
/// speed is below choice.minimum_speed of its top speed in this log for longer than a reversal takes (ten times the
/// dwell of a reversal at the joint's top acceleration within 1 % of its top speed, and two samples). At rest, or
/// sticking, friction may take any value up to that of breakaway, which no sign(qd) tells. Reversals are passed quickly
/// and keep their rows.
///  - A joint held in the whole log (held_range) keeps all its rows: it has noise for a speed, and it is the only one
///  to
///    tell of gravity at that position.
///  - The top speed is that of the log, not of all logs, so that a log of slow motion is not left out as a whole.
/// Depends on the speeds alone, neither on the model nor on the torque. Throws std::invalid_argument if the log is too
/// short to decimate.
row_selection select_rows(const filtered_samples& samples, const filter_choice& choice);

/// Evaluates the regressor on the states that the torques of every log belong to (recorded_states), decimates its
/// columns and the torque in parallel (METHODS.md, IDIM-LS 3): same zero-phase filter, same samples kept; then takes
/// the rows that select_rows names, but for those whose state would lie outside the log. Where rows depend on the
/// parameters (depends_on_parameters) they are those of `chi` [b], or of no estimate yet.
observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                    const filter_choice& choice, const Eigen::VectorXd& chi = {});

/// The same with given rows, one selection per log: instruments along a simulated trajectory take those of the measured
/// one (`kept` of its blocks). `chi` [b]: the estimate that rows are of if they depend on the parameters. Throws
/// std::invalid_argument if they do not fit the logs.
observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                    const filter_choice& choice, const std::vector<row_selection>& kept,
                    const Eigen::VectorXd& chi = {});

}  // namespace idim
