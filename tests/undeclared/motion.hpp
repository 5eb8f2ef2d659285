#pragma once

#include <Eigen/Core>
#include <vector>

#include "undeclared/arm.hpp"
#include "undeclared/sampler.hpp"

namespace idim::undeclared {

/// Reference of all joints at one time.
struct reference_point {
    Eigen::VectorXd q, qd, qdd;
};

/// A sum of sinusoids a joint, within the limits of position and velocity, eased in over the first 2 s.
class motion {
  public:
    /// duration [s]; `period` [s]: every frequency is a multiple of its inverse, 0 for a motion that never repeats;
    /// top_frequency [Hz]: the fastest sinusoid of any joint.
    motion(const arm& robot, double duration, double period, double top_frequency, sampler& random);

    double duration() const { return duration_; }
    reference_point at(double t) const;

  private:
    struct sinusoid {
        double amplitude, pulsation, phase;
    };
    double duration_;
    std::vector<std::vector<sinusoid>> joints_;
};

}  // namespace idim::undeclared
