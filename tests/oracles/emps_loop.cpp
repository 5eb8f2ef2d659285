#include "oracles/emps_loop.hpp"

#include <algorithm>
#include <cmath>

namespace idim::test {

log emps_loop::motion(const Eigen::VectorXd& chi, const log& recorded, double kv_scale) const {
    constexpr int substeps = 10;
    const Eigen::Index samples = recorded.t.size();
    log result;
    result.t = recorded.t;
    result.q.resize(samples, 1);
    result.tau.resize(samples, 1);
    double q = recorded.qr(0, 0);
    double qd = 0.0;
    double before = q;
    double average_before = q;
    double held = 0.0;
    for (Eigen::Index k = 0; k < samples; ++k) {
        const double period = k + 1 < samples ? recorded.t[k + 1] - recorded.t[k] : recorded.t[k] - recorded.t[k - 1];
        const double average = 0.5 * (q + before);
        const double d = (average - average_before) / period;
        const double u = std::clamp(kv_scale * kv * (kp * (recorded.qr(k, 0) - q) - d), -saturation, saturation);
        const double force = gain * u;
        result.q(k, 0) = q;
        result.tau(k, 0) = 0.5 * ((k == 0 ? force : held) + force);
        held = force;
        before = q;
        average_before = average;
        for (int s = 0; s < substeps; ++s) {
            // Exact between changes of sign: friction of one sign leaves a linear equation. A reversal stops the axis
            // for the rest of the substep.
            const double h = period / substeps;
            const double push = force - chi[3];
            if (qd == 0.0 && std::abs(push) <= chi[2]) {
                continue;
            }
            const double sign = qd != 0.0 ? std::copysign(1.0, qd) : std::copysign(1.0, push);
            const double final_speed = (push - sign * chi[2]) / std::max(chi[1], 1e-9);
            const double decay = std::exp(-h * std::max(chi[1], 1e-9) / chi[0]);
            const double next = final_speed + (qd - final_speed) * decay;
            q += 0.5 * h * (qd + next);
            qd = next * sign < 0.0 ? 0.0 : next;
        }
    }
    return result;
}

}  // namespace idim::test
