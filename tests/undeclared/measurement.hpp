#pragma once

#include <Eigen/Core>
#include <string>

#include "undeclared/sampler.hpp"

namespace idim::undeclared {

/// How a signal is disturbed on its way into a log.
struct noise {
    std::string kind = "white";  ///< white | coloured (first-order, corner frequency below) | quantised
    Eigen::VectorXd size;        ///< by joint: deviation, or the step of a quantised signal
    double corner = 0.0;         ///< [Hz]
};

/// Adds one sample of noise after another to the signals of all joints, sampled at `rate` [Hz].
class noise_source {
  public:
    noise_source(const noise& settings, double rate, const sampler& random);
    Eigen::VectorXd disturbed(const Eigen::VectorXd& value);

  private:
    noise settings_;
    double memory_;  ///< how much of the last sample is left in the next
    Eigen::VectorXd state_;
    sampler random_;
};

}  // namespace idim::undeclared
