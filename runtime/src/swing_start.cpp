#include "swing_start.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace idim {

namespace {

constexpr Eigen::Index shortest_motion = 4;  // samples of a motion
constexpr double most_swings = 16.0;
constexpr double decays = 3.0;                // to a twentieth
constexpr double least_period_samples = 4.0;  // of a swing that the sampling shows

twist_state nothing(Eigen::Index s) {
    return {Eigen::VectorXd::Zero(s), Eigen::VectorXd::Zero(s)};
}

/// Frequency w [rad/s] and damping ratio of every link behind its own transmission alone, as at the first sample.
struct link_modes {
    Eigen::ArrayXd w;
    Eigen::ArrayXd ratio;

    link_modes(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft) {
        const auto s = static_cast<Eigen::Index>(soft.size());
        const Eigen::ArrayXd M = dynamics.inertia.row(0).reshaped(s, s).diagonal().array();
        const Eigen::ArrayXd K = stiffnesses(soft);
        w = (K / M).sqrt();
        ratio = (dampings(soft).array() / (2.0 * (K * M).sqrt())).max(least_damping_ratio);
    }
};

bool has_inertia(const swing_dynamics& dynamics, Eigen::Index s) {
    return dynamics.inertia.rows() >= shortest_motion &&
           dynamics.inertia.row(0).reshaped(s, s).diagonal().minCoeff() > 0.0;
}

/// Torque at the motors' side of links that swing by themselves from a state, samples after samples [samples x s].
Eigen::MatrixXd free_torque(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate,
                            const twist_state& start) {
    const swing_dynamics undriven{Eigen::MatrixXd::Zero(dynamics.forcing.rows(), dynamics.forcing.cols()),
                                  dynamics.inertia};
    const twist_motion twist = swing(undriven, soft, rate, start);
    const Eigen::Index s = dynamics.forcing.cols();
    Eigen::MatrixXd torque(dynamics.forcing.rows(), s);
    for (Eigen::Index k = 0; k < torque.rows(); ++k) {
        torque.row(k) = -dynamics.inertia.row(k).reshaped(s, s) * twist.acceleration.row(k).transpose();
    }
    return torque;
}

}  // namespace

twist_state operator+(const twist_state& a, const twist_state& b) {
    return {a.angle + b.angle, a.rate + b.rate};
}

twist_state slow_start(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    const Eigen::Index n = dynamics.forcing.rows();
    if (!has_inertia(dynamics, s)) {
        return nothing(s);
    }
    const Eigen::MatrixXd M = dynamics.inertia.row(0).reshaped(s, s);
    const Eigen::VectorXd K = stiffnesses(soft);
    const link_modes modes(dynamics, soft);
    const Eigen::VectorXd D = 2.0 * modes.ratio * (K.array() * M.diagonal().array()).sqrt();
    const double swing_time = 2.0 * M_PI / modes.w.minCoeff();
    const auto apart = static_cast<Eigen::Index>(std::lround(0.25 * swing_time * rate));
    const Eigen::Index step = std::clamp<Eigen::Index>(apart, 1, (n - 1) / 3);
    const double h = static_cast<double>(step) / rate;
    const auto F = [&](Eigen::Index k) { return Eigen::VectorXd(dynamics.forcing.row(k * step)); };
    const Eigen::VectorXd first = (-11.0 * F(0) + 18.0 * F(1) - 9.0 * F(2) + 2.0 * F(3)) / (6.0 * h);
    const Eigen::VectorXd second = (2.0 * F(0) - 5.0 * F(1) + 4.0 * F(2) - F(3)) / (h * h);
    const Eigen::VectorXd third = (F(3) - 3.0 * F(2) + 3.0 * F(1) - F(0)) / (h * h * h);
    const auto twist = [&](const Eigen::VectorXd& f, const Eigen::VectorXd& fd, const Eigen::VectorXd& fdd) {
        return Eigen::VectorXd((f - D.cwiseProduct(fd.cwiseQuotient(K)) - M * fdd.cwiseQuotient(K)).cwiseQuotient(K));
    };
    return {twist(F(0), first, second), twist(first, second, third)};
}

Eigen::Index free_samples(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate) {
    const Eigen::Index n = dynamics.forcing.rows();
    if (!has_inertia(dynamics, static_cast<Eigen::Index>(soft.size()))) {
        return 0;
    }
    const link_modes modes(dynamics, soft);
    const double seconds = ((decays / modes.ratio).min(2.0 * M_PI * most_swings) / modes.w).maxCoeff();
    return static_cast<Eigen::Index>(std::min(seconds * rate, static_cast<double>(n)));
}

twist_state free_start(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate,
                       const Eigen::MatrixXd& lacking) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    const Eigen::Index n = lacking.rows();
    twist_state found = nothing(s);
    if (n <= 2 * s || !has_inertia(dynamics, s) || !lacking.allFinite()) {
        return found;
    }
    const link_modes modes(dynamics, soft);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n * s, 2 * s);
    for (Eigen::Index i = 0; i < s; ++i) {
        if (modes.w[i] * least_period_samples < 2.0 * M_PI * rate) {
            twist_state unit = nothing(s);
            unit.angle[i] = 1.0;
            columns.col(i) = free_torque(dynamics, soft, rate, unit).reshaped();
            unit = nothing(s);
            unit.rate[i] = modes.w[i];
            columns.col(s + i) = free_torque(dynamics, soft, rate, unit).reshaped();
        }
    }
    const Eigen::VectorXd x = columns.colPivHouseholderQr().solve(Eigen::VectorXd(lacking.reshaped()));
    found.angle = x.head(s);
    found.rate = x.tail(s).cwiseProduct(modes.w.matrix());
    return found;
}

}  // namespace idim
