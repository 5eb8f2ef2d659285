#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"

namespace idim {

/// The over-determined system Y = W chi + rho of [IV 10-14], kept joint by joint and log by log so that nothing is ever filtered,
/// correlated or split across a seam: rows of joint j stand in blocks[log].joints[j].
struct observation_block {
    std::string file;
    double rate = 0.0;               ///< rate of the rows, after decimation [Hz]
    Eigen::VectorXd t;               ///< time of the rows [s]
    std::vector<Eigen::MatrixXd> W;  ///< per joint: rows x b [unit of the torque per unit of the parameter]
    std::vector<Eigen::VectorXd> Y;  ///< per joint: rows [N*m or N]
};

struct observation {
    std::vector<observation_block> blocks;
    int dof = 0;
    int n_base = 0;

    /// Rows of joint j over all blocks.
    Eigen::Index rows(int joint) const;
    /// Rows of all joints over all blocks.
    Eigen::Index rows() const;
};

/// Evaluates the regressor on the samples of every log and decimates its columns and the torque in parallel (METHODS.md,
/// IDIM-LS 3): same zero-phase filter, same samples kept.
observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs, const filter_choice& choice);

}  // namespace idim
