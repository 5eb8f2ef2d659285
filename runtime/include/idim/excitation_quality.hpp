#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/fourier_series.hpp"
#include "idim/model_interface.h"

namespace idim {

/// How well a motion shows the base parameters. W [N n x b] are the regressor rows of one period at N equal steps, not
/// weighted; S the Gram matrix of its columns divided by their norms.
struct excitation_quality {
    double condition_number = 0.0;         ///< of W, in the units of the parameters
    double scaled_condition_number = 0.0;  ///< of W with columns of norm one
    double log_determinant = 0.0;          ///< of the information of a row, W'W / N; -infinity where W has no full rank
    /// sqrt of the diagonal of S^-1 [b], 1 or more: how many times wider the deviation of a parameter is than if all
    /// others were known. Infinite for all where W has no full rank.
    Eigen::VectorXd inflation;
    /// Root mean square of a parameter's torque per unit, over all joints, less what others can show [b]: with N
    /// samples and white torque noise of deviation s the parameter's own is s / (sqrt(N) independent_torque).
    Eigen::VectorXd independent_torque;
    Eigen::MatrixXd information;  ///< W'W / N [b x b]

    /// Root mean square of the torque of all joints together, of parameters chi [b].
    double torque(const Eigen::VectorXd& chi) const;
};

excitation_quality judge_excitation(const idim_model_interface& model, const motion_samples& motion);

/// The same for one period of a series, at instants that are enough for it.
excitation_quality judge_excitation(const idim_model_interface& model, const fourier_series& series);

}  // namespace idim
