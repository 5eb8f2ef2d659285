#pragma once

#include <Eigen/Core>
#include <deque>
#include <memory>

#include "idim/model_interface.h"

namespace idim {

/// What a controller knows at one of its samples; all vectors [n], joint side [rad or m, and per s].
struct control_sample {
    double t = 0.0;         ///< [s]
    Eigen::VectorXd qr;     ///< reference position
    Eigen::VectorXd qdr;    ///< its velocity
    Eigen::VectorXd qddr;   ///< its acceleration
    Eigen::VectorXd q, qd;  ///< measured position and velocity
};

/// A sampled control law: at each sample a drive command, limited to +-saturation, that is held until the next one and
/// reaches the drive `delay` samples later (zero until then). A law has memory: loops that run side by side take a
/// clone each, and reset() comes before a motion.
class control_law {
  public:
    virtual ~control_law() = default;

    double rate = 0.0;           ///< sampling rate [Hz]
    Eigen::VectorXd drive_gain;  ///< [n] g, N*m or N per unit of drive command
    Eigen::VectorXd saturation;  ///< [n] largest drive command; empty where there is none
    int delay = 0;               ///< [samples]

    virtual std::unique_ptr<control_law> clone() const = 0;
    /// Gains that depend on the inertia J [n, kg*m^2 or kg] for the present estimate of it [IV 46]; those given as
    /// numbers stay.
    virtual void tune(const Eigen::VectorXd& inertia);
    /// Drive command [n] that takes effect now.
    Eigen::VectorXd command(const control_sample& sample);
    /// g times command(), torque or force [n].
    Eigen::VectorXd torque(const control_sample& sample);
    /// Forgets all former samples.
    void reset();

  protected:
    control_law() = default;
    control_law(const control_law&) = default;
    control_law& operator=(const control_law&) = default;

    /// Drive command [n] before saturation and delay.
    virtual Eigen::VectorXd unlimited(const control_sample& sample) = 0;
    /// Told after each sample what saturation left of the command: integrators stop there.
    virtual void limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given);
    virtual void forget();

  private:
    std::deque<Eigen::VectorXd> late_;  ///< commands on their way
};

/// J_j = largest M_jj(q) over the joint space [IV 38], by sampling: revolute joints over a turn, prismatic ones over
/// -1..1 m, closed loops where they close with 30 degrees or more at the cut.
Eigen::VectorXd largest_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi);

}  // namespace idim
