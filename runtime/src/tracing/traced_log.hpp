#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/observation.hpp"

namespace idim {

/// Rows of one joint at which its speed passes through zero, or is too small for its sign to be known.
using row_flags = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// One log as the tracer sees it: the motion at the full rate, from which columns of effects are computed, and the
/// decimated rows on which everything is judged.
struct traced_log {
    filtered_samples samples;
    observation_block rows;
    int decimation = 1;
    bool held_back = false;           ///< never used to fit
    std::vector<row_flags> reversal;  ///< per joint, one flag a row
    Eigen::MatrixXd tau_model;        ///< torque of the present model at the full rate, samples x n [N*m or N]
    Eigen::VectorXd chi_rigid;        ///< [b] the present parameters of the rigid links, all others zero
    Eigen::MatrixXd tau_rigid;        ///< the part of the rigid links, what the transmissions carry
    Eigen::MatrixXd inertia;          ///< M of the rigid links, samples x n*n: row i, column j at j*n + i; none where
                                      ///< effects have signals of their own
};

/// Filters columns at the full rate (samples x m) as the torque is, and takes the rows that `joint` has.
Eigen::MatrixXd rows_of(const traced_log& log, int joint, const Eigen::MatrixXd& columns);

/// Rows, flags and the places of both logs' samples. `choice` is that of the identification.
traced_log make_traced_log(const idim_model_interface& model, filtered_samples samples, const filter_choice& choice,
                           bool held_back);

/// Torques of the present parameters chi [b] along the log; a base parameter is of the rigid links if its name is one
/// of XX..M of some link. Sets tau_model, chi_rigid, tau_rigid and inertia.
void update_torques(const idim_model_interface& model, const Eigen::VectorXd& chi, traced_log& log);
/// The parameters of the rigid links, all others zero.
Eigen::VectorXd rigid_part(const idim_model_interface& model, Eigen::VectorXd chi);

}  // namespace idim
