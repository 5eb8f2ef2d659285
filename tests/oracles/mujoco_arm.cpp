#include "oracles/mujoco_arm.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace idim::test {

log mujoco_arm::record(const log& reference, std::uint64_t seed) const {
    constexpr int substeps = 2;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::Index n = kp.size();
    const Eigen::Index samples = reference.t.size();
    log recorded;
    recorded.file = "arm";
    recorded.t = reference.t;
    recorded.qr = reference.qr;
    recorded.q.resize(samples, n);
    recorded.tau.resize(samples, n);
    Eigen::VectorXd q = reference.qr.row(0);
    Eigen::VectorXd qd = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd held;
    const auto acceleration = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& v, const Eigen::VectorXd& tau) {
        const Eigen::VectorXd friction = viscous.cwiseProduct(v) + coulomb.cwiseProduct(v.cwiseSign());
        return robot.forward_dynamics(at, v, tau - friction, rotor);
    };
    for (Eigen::Index k = 0; k < samples; ++k) {
        Eigen::VectorXd seen = q;
        for (double& value : seen) {
            value += position_noise * normal(random);
        }
        const Eigen::VectorXd error = reference.qr.row(k).transpose() - seen;
        const Eigen::VectorXd tau = kv.cwiseProduct(kp.cwiseProduct(error) - qd);
        held = k == 0 ? tau : held;
        recorded.q.row(k) = seen;
        for (Eigen::Index j = 0; j < n; ++j) {
            recorded.tau(k, j) = 0.5 * (held[j] + tau[j]) + torque_noise[j] * normal(random);
        }
        held = tau;
        const double h = 1.0 / rate / substeps;
        for (int s = 0; s < substeps; ++s) {
            const Eigen::VectorXd a1 = acceleration(q, qd, tau);
            const Eigen::VectorXd v2 = qd + 0.5 * h * a1;
            const Eigen::VectorXd a2 = acceleration(q + 0.5 * h * qd, v2, tau);
            const Eigen::VectorXd v3 = qd + 0.5 * h * a2;
            const Eigen::VectorXd a3 = acceleration(q + 0.5 * h * v2, v3, tau);
            const Eigen::VectorXd v4 = qd + h * a3;
            const Eigen::VectorXd a4 = acceleration(q + h * v3, v4, tau);
            q += h / 6.0 * (qd + 2.0 * v2 + 2.0 * v3 + v4);
            qd += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
    }
    return recorded;
}

log arm_reference(const Eigen::VectorXd& centre, double amplitude, double seconds, std::uint64_t seed) {
    constexpr int harmonics = 8;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
    const auto samples = static_cast<Eigen::Index>(std::round(seconds * 1000.0)) + 1;
    log reference;
    reference.t = Eigen::VectorXd::LinSpaced(samples, 0.0, seconds);
    reference.qr = centre.transpose().replicate(samples, 1);
    for (Eigen::Index j = 0; j < centre.size(); ++j) {
        for (int i = 1; i <= harmonics; ++i) {
            const double phase = turn(random);
            for (Eigen::Index k = 0; k < samples; ++k) {
                const double t = reference.t[k];
                const double ease = t < 3.0 ? 0.5 * (1.0 - std::cos(std::numbers::pi * t / 3.0)) : 1.0;
                reference.qr(k, j) += ease * amplitude / 3.0 * std::sin(2.0 * std::numbers::pi * 0.1 * i * t + phase);
            }
        }
    }
    return reference;
}

}  // namespace idim::test
