#include "oracles/scara_loop.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

#include "support/sign.hpp"

namespace idim::test {

namespace {

/// qdd of [IV 53] solved for the accelerations.
Eigen::Vector2d acceleration(const Eigen::VectorXd& chi, const Eigen::Vector2d& q, const Eigen::Vector2d& qd,
                             const Eigen::Vector2d& tau) {
    const double c = std::cos(q[1]);
    const double s = std::sin(q[1]);
    const double coupling = chi[4] * c - chi[5] * s;
    Eigen::Matrix2d M;
    M << chi[0] + chi[3] + 2.0 * coupling, chi[3] + coupling, chi[3] + coupling, chi[3];
    const double centrifugal = chi[4] * s + chi[5] * c;
    const Eigen::Vector2d N(-centrifugal * qd[1] * (2.0 * qd[0] + qd[1]) + chi[1] * qd[0] + chi[2] * sign(qd[0]),
                            centrifugal * qd[0] * qd[0] + chi[6] * qd[1] + chi[7] * sign(qd[1]));
    return M.inverse() * (tau - N);
}

void step(const Eigen::VectorXd& chi, double h, const Eigen::Vector2d& tau, Eigen::Vector2d& q, Eigen::Vector2d& qd) {
    const Eigen::Vector2d a1 = acceleration(chi, q, qd, tau);
    const Eigen::Vector2d v2 = qd + 0.5 * h * a1;
    const Eigen::Vector2d a2 = acceleration(chi, q + 0.5 * h * qd, v2, tau);
    const Eigen::Vector2d v3 = qd + 0.5 * h * a2;
    const Eigen::Vector2d a3 = acceleration(chi, q + 0.5 * h * v2, v3, tau);
    const Eigen::Vector2d v4 = qd + h * a3;
    const Eigen::Vector2d a4 = acceleration(chi, q + h * v3, v4, tau);
    q += h / 6.0 * (qd + 2.0 * v2 + 2.0 * v3 + v4);
    qd += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

}  // namespace

log scara_loop::record(const log& reference, std::uint64_t seed) const {
    constexpr int substeps = 10;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&](const Eigen::Vector2d& deviation) -> Eigen::Vector2d {
        const double first = normal(random);
        return {deviation[0] * first, deviation[1] * normal(random)};
    };
    const Eigen::Vector2d inertia(chi[0] + chi[3] + 2.0 * chi[4], chi[3]);
    const Eigen::Vector2d kp = natural_frequency / 2.0;
    const Eigen::Vector2d kv = 2.0 * natural_frequency.cwiseProduct(inertia);
    const double memory = std::exp(-2.0 * std::numbers::pi * disturbance_corner / rate);
    const Eigen::Index samples = reference.t.size();
    log recorded;
    recorded.file = "scara";
    recorded.t = reference.t;
    recorded.qr = reference.qr;
    recorded.q.resize(samples, 2);
    recorded.tau.resize(samples, 2);
    Eigen::Vector2d q = reference.qr.row(0);
    Eigen::Vector2d qd = Eigen::Vector2d::Zero();
    Eigen::Vector2d pushed = noise(disturbance);
    Eigen::Vector2d held;
    for (Eigen::Index k = 0; k < samples; ++k) {
        const Eigen::Vector2d seen = q + noise(position_noise);
        const Eigen::Vector2d error = reference.qr.row(k).transpose() - seen;
        const Eigen::Vector2d tau = kv.cwiseProduct(kp.cwiseProduct(error) - qd);
        held = k == 0 ? tau : held;
        recorded.q.row(k) = seen;
        // A current measurement averages over the periods on both sides of the sample.
        recorded.tau.row(k) = 0.5 * (held + tau) + noise(torque_noise);
        held = tau;
        for (int s = 0; s < substeps; ++s) {
            step(chi, 1.0 / rate / substeps, tau + pushed, q, qd);
        }
        pushed = memory * pushed + std::sqrt(1.0 - memory * memory) * noise(disturbance);
    }
    return recorded;
}

log scara_reference(double seconds) {
    constexpr double slow[] = {0.03, 0.05, 0.08, 0.12, 0.17};
    constexpr double fast[] = {0.11, 0.19, 0.31, 0.47, 0.67};
    const auto samples = static_cast<Eigen::Index>(std::round(seconds * 200.0)) + 1;
    log reference;
    reference.t = Eigen::VectorXd::LinSpaced(samples, 0.0, seconds);
    reference.qr = Eigen::MatrixXd::Zero(samples, 2);
    for (Eigen::Index k = 0; k < samples; ++k) {
        const double t = reference.t[k];
        const double ease = t < 4.0 ? 0.5 * (1.0 - std::cos(std::numbers::pi * t / 4.0)) : 1.0;
        for (int i = 0; i < 5; ++i) {
            reference.qr(k, 0) += ease * 2.0 * std::sin(2.0 * std::numbers::pi * slow[i] * t + (i + 1) * (i + 1));
            reference.qr(k, 1) += ease * 0.8 * std::sin(2.0 * std::numbers::pi * fast[i] * t + (i + 1) * (i + 2));
        }
    }
    return reference;
}

}  // namespace idim::test
