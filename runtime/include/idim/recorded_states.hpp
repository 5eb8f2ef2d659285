#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"

namespace idim {

/// Whether rows depend on the parameters themselves: effects of the torque of the links, or soft transmissions. Then
/// they are those of an estimate.
bool depends_on_parameters(const idim_model_interface& model);

/// Of the transmission of a joint [N*m/rad or N/m]; 0 where it is rigid.
double stiffness_of(const idim_model_interface& model, int joint);

/// Of the transmission of a joint [N*m*s/rad or N*s/m].
double damping_of(const idim_model_interface& model, int joint);

/// Whether a transmission is not rigid.
bool has_soft_joint(const idim_model_interface& model);

/// Samples at t - shift, by cubic interpolation; the first and last sample stand for what is outside the log. The
/// torque stays as it is.
filtered_samples earlier(const filtered_samples& samples, double shift);

/// Samples with all that the model reads beside the motion in `temp` (see model_interface.h), at the full rate:
/// temperatures, states of effects run from the first sample on, and where there are soft transmissions the motion of
/// the links as they swing behind their motors, tau_rigid(link) = K (motor - link) + D (motor - link)'; that of the
/// motors is then a signal. `chi` [b]: where it is empty the measured torque stands for that of the links. Where
/// torques are measured, they say how the links swing at first, two values for each soft transmission.
filtered_samples completed(const idim_model_interface& model, const filtered_samples& samples,
                           const Eigen::VectorXd& chi);

/// The states of a robot that the torques of a log belong to: completed, and for each joint as much earlier as its
/// torque is recorded late. `samples` must outlive it.
class recorded_states {
  public:
    recorded_states(const idim_model_interface& model, const filtered_samples& samples, const Eigen::VectorXd& chi);

    const filtered_samples& of(int joint) const;

  private:
    const filtered_samples& measured_;
    std::vector<int> place_;  ///< per joint: into states_, -1 for the measured ones themselves
    std::vector<filtered_samples> states_;
};

/// Torques of the model along a log, samples x n, with delays, states and soft transmissions as declared.
Eigen::MatrixXd model_torques(const idim_model_interface& model, const filtered_samples& samples,
                              const Eigen::VectorXd& chi);

}  // namespace idim
