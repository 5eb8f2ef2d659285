#pragma once

#include <Eigen/Core>
#include <random>

#include "idim/model_interface.h"

namespace idim {

/// Whether all loops close at positions q [n], the squared sines of the angles at their cuts above `least`.
bool loops_close(const idim_model_interface& model, const double* q, double least = 0.0);

/// Positions of a robot spread evenly over revolute joints by a turn and prismatic ones from -1 to 1 m, the first of
/// them zero; the same ones every time. Those where a loop does not close, or with less than 30 degrees at its cut, are
/// left out: linkages are not driven there, and their inertia grows past all bounds as the angle goes to zero.
class joint_space {
  public:
    explicit joint_space(const idim_model_interface& model);

    /// Positions [n]. Where none of 10^5 in a row closes, the last of them.
    const Eigen::VectorXd& next();

  private:
    void draw();

    const idim_model_interface& model_;
    std::mt19937_64 random_{1};
    bool at_zero_ = true;
    Eigen::VectorXd q_;
};

}  // namespace idim
