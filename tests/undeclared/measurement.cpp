#include "undeclared/measurement.hpp"

#include <cmath>
#include <numbers>

namespace idim::undeclared {

noise_source::noise_source(const noise& settings, double rate, const sampler& random)
    : settings_(settings),
      memory_(settings.kind == "coloured" ? std::exp(-2.0 * std::numbers::pi * settings.corner / rate) : 0.0),
      state_(Eigen::VectorXd::Zero(settings.size.size())),
      random_(random) {}

Eigen::VectorXd noise_source::disturbed(const Eigen::VectorXd& value) {
    if (settings_.kind == "quantised") {
        return (value.cwiseQuotient(settings_.size).array().round()).matrix().cwiseProduct(settings_.size);
    }
    for (double& state : state_) {
        state = memory_ * state + std::sqrt(1.0 - memory_ * memory_) * random_.normal();
    }
    return value + state_.cwiseProduct(settings_.size);
}

}  // namespace idim::undeclared
