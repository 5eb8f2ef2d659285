#include "undeclared/motion.hpp"

#include <algorithm>
#include <numbers>

namespace idim::undeclared {

namespace {

using std::numbers::pi;

constexpr double ease_time = 2.0;  // [s]

/// A factor on the motion and its two derivatives: half a cosine from 0 to 1.
struct easing {
    double value, first, second;
};

easing eased(double t) {
    if (t >= ease_time) {
        return {1.0, 0.0, 0.0};
    }
    const double w = pi / ease_time;
    return {0.5 * (1.0 - std::cos(w * t)), 0.5 * w * std::sin(w * t), 0.5 * w * w * std::cos(w * t)};
}

}  // namespace

motion::motion(const arm& robot, double duration, double period, double top_frequency, sampler& random)
    : duration_(duration) {
    for (const drive& limits : robot.drives) {
        std::vector<sinusoid> parts;
        const int count = 4 + random.below(4);
        double position = 0.0, velocity = 0.0;
        for (int i = 0; i < count; ++i) {
            double frequency = random.uniform(0.05, top_frequency);
            if (period > 0.0) {
                frequency = std::max(1.0, std::round(frequency * period)) / period;
            }
            const double w = 2.0 * pi * frequency;
            parts.push_back({random.uniform(0.3, 1.0) / std::sqrt(frequency), w, random.uniform(0.0, 2.0 * pi)});
            position += parts.back().amplitude;
            velocity += parts.back().amplitude * w;
        }
        // Sums of amplitudes are never reached by as many sinusoids: 1.4 is their usual distance from the peak.
        const double scale = 1.4 * std::min(limits.position_limit / position, limits.velocity_limit / velocity);
        for (sinusoid& part : parts) {
            part.amplitude *= scale;
        }
        joints_.push_back(parts);
    }
    // Frequencies of one joint may coincide by rounding to the period: harmless, their sum is one sinusoid.
}

reference_point motion::at(double t) const {
    const Eigen::Index n = static_cast<Eigen::Index>(joints_.size());
    reference_point point{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    const easing ease = eased(t);
    for (Eigen::Index j = 0; j < n; ++j) {
        double q = 0.0, qd = 0.0, qdd = 0.0;
        for (const sinusoid& part : joints_[static_cast<std::size_t>(j)]) {
            const double w = part.pulsation, angle = w * t + part.phase;
            q += part.amplitude * std::sin(angle);
            qd += part.amplitude * w * std::cos(angle);
            qdd -= part.amplitude * w * w * std::sin(angle);
        }
        point.q[j] = ease.value * q;
        point.qd[j] = ease.value * qd + ease.first * q;
        point.qdd[j] = ease.value * qdd + 2.0 * ease.first * qd + ease.second * q;
    }
    return point;
}

}  // namespace idim::undeclared
