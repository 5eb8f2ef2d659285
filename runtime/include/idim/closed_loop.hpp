#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "idim/log.hpp"

namespace idim {

/// The robot and its controller as an identification simulates them.
struct closed_loop {
    /// Noise-free motion under chi [b] along the reference of a recorded log: t as recorded, q, and tau where known.
    /// Starts at (qr(0), qdr(0)). Throws data_error naming time and joint where the inertia matrix of chi is not
    /// positive definite on the way or the motion diverges. May be called from several threads at once.
    std::function<log(const Eigen::VectorXd& chi, const log& recorded)> motion;
    /// [n] natural frequency wn of the simulated loop [rad/s]; rows within 5 / min wn of a start are transient
    /// [IV 3.4].
    Eigen::VectorXd natural_frequency;
    /// What was assumed of the controller, one sentence for the report; empty where the declared law is simulated.
    std::string assumption;
};

}  // namespace idim
