#include "link_swing.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace idim {

namespace {

constexpr double least_damping_ratio = 0.01;
constexpr Eigen::Index shortest_motion = 4;  // samples of a motion

/// x'' + c x' + w^2 x = f, f straight between samples.
struct mode {
    double damping;  ///< c [1/s]
    double square;   ///< w^2 [1/s^2]

    /// Moves x, x' by h seconds without f.
    void move_free(double h, double& x, double& v) const {
        const double a = 0.5 * damping;
        const double d = a * a - square;
        const double w = std::sqrt(std::abs(d));
        double c = std::exp(-a * h);  // of the cosine or its hyperbolic relative, decay included
        double s = c * h;             // of the sine over w
        if (w * h > 1e-6 && d < 0.0) {
            s = c * std::sin(w * h) / w;
            c *= std::cos(w * h);
        } else if (w * h > 1e-6) {
            const double slow = std::exp((w - a) * h);
            const double fast = std::exp(-(w + a) * h);
            c = 0.5 * (slow + fast);
            s = 0.5 * (slow - fast) / w;
        }
        const double moved = x * (c + a * s) + v * s;
        v = v * (c - a * s) - square * x * s;
        x = moved;
    }

    void move(double h, double from, double to, double& x, double& v) const {
        const double slope = (to - from) / h;
        const double lag = damping * slope / square;
        x -= (from - lag) / square;
        v -= slope / square;
        move_free(h, x, v);
        x += (to - lag) / square;
        v += slope / square;
    }
};

mode damped(const mode& given) {
    return {std::max(given.damping, 2.0 * least_damping_ratio * std::sqrt(given.square)), given.square};
}

Eigen::VectorXd stiffnesses(const std::vector<soft_transmission>& soft) {
    Eigen::VectorXd K(static_cast<Eigen::Index>(soft.size()));
    std::transform(soft.begin(), soft.end(), K.begin(), [](const soft_transmission& t) { return t.stiffness; });
    return K;
}

Eigen::VectorXd dampings(const std::vector<soft_transmission>& soft) {
    Eigen::VectorXd D(static_cast<Eigen::Index>(soft.size()));
    std::transform(soft.begin(), soft.end(), D.begin(), [](const soft_transmission& t) { return t.damping; });
    return D;
}

/// Modes of links that swing behind motors held still.
class swing_modes {
  public:
    explicit swing_modes(const std::vector<soft_transmission>& soft) : K_(stiffnesses(soft)), D_(dampings(soft)) {}

    /// For the inertia M [s x s]; false if it is not positive definite.
    bool take(const Eigen::MatrixXd& M) {
        if (!M.allFinite() || Eigen::LLT<Eigen::MatrixXd>(M).info() != Eigen::Success) {
            return false;
        }
        solver_.compute(Eigen::MatrixXd(K_.asDiagonal()), M);
        shapes_ = solver_.eigenvectors();
        to_modes_ = shapes_.transpose() * M;
        modes_.clear();
        for (Eigen::Index i = 0; i < K_.size(); ++i) {
            const double square = solver_.eigenvalues()[i];
            const double given = shapes_.col(i).dot(D_.cwiseProduct(shapes_.col(i)));
            modes_.push_back(damped({given, square}));
        }
        return true;
    }

    /// One sample on: angle, rate and acceleration of the twist [s].
    void move(double h, const Eigen::VectorXd& from, const Eigen::VectorXd& to, Eigen::VectorXd& angle,
              Eigen::VectorXd& rate, Eigen::VectorXd& acceleration) const {
        Eigen::VectorXd x = to_modes_ * angle;
        Eigen::VectorXd v = to_modes_ * rate;
        Eigen::VectorXd a(x.size());
        const Eigen::VectorXd f0 = shapes_.transpose() * from;
        const Eigen::VectorXd f1 = shapes_.transpose() * to;
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            const mode& one = modes_[static_cast<std::size_t>(i)];
            one.move(h, f0[i], f1[i], x[i], v[i]);
            a[i] = f1[i] - one.damping * v[i] - one.square * x[i];
        }
        angle = shapes_ * x;
        rate = shapes_ * v;
        acceleration = shapes_ * a;
    }

  private:
    Eigen::VectorXd K_;
    Eigen::VectorXd D_;
    Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
    Eigen::MatrixXd shapes_;
    Eigen::MatrixXd to_modes_;
    std::vector<mode> modes_;
};

/// Twist and its rate as a motion much slower than the swing begins it: K twist = F - D F'/K - M F''/K, with the
/// derivatives of a cubic through samples a quarter of the slowest swing apart. What is not so would swing freely at
/// first.
std::pair<Eigen::VectorXd, Eigen::VectorXd> slow_start(const swing_dynamics& dynamics,
                                                       const std::vector<soft_transmission>& soft, double rate) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    const Eigen::Index n = dynamics.forcing.rows();
    const Eigen::MatrixXd M = dynamics.inertia.row(0).reshaped(s, s);
    const Eigen::VectorXd K = stiffnesses(soft);
    const Eigen::VectorXd D =
        dampings(soft).cwiseMax(2.0 * least_damping_ratio * K.cwiseProduct(M.diagonal()).cwiseSqrt());
    const double swing_time = 2.0 * M_PI * std::sqrt(M.diagonal().cwiseQuotient(K).maxCoeff());
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

/// swing of one link, without matrices: a search tries many stiffnesses.
twist_motion swing_of_one(const swing_dynamics& dynamics, const soft_transmission& soft, double rate) {
    const Eigen::Index n = dynamics.forcing.rows();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const auto F = dynamics.forcing.col(0);
    const auto M = dynamics.inertia.col(0);
    if (n < shortest_motion || !(M.minCoeff() > 0.0)) {
        return {none, none, none};
    }
    twist_motion found{none, none, none};
    const auto [first_angle, first_rate] = slow_start(dynamics, {soft}, rate);
    double angle = first_angle[0];
    double speed = first_rate[0];
    found.angle(0) = angle;
    found.rate(0) = speed;
    for (Eigen::Index k = 1; k < n; ++k) {
        const double inertia = 0.5 * (M[k - 1] + M[k]);
        const mode one = damped({soft.damping / inertia, soft.stiffness / inertia});
        one.move(1.0 / rate, F[k - 1] / inertia, F[k] / inertia, angle, speed);
        found.angle(k) = angle;
        found.rate(k) = speed;
        found.acceleration(k) = F[k] / inertia - one.damping * speed - one.square * angle;
    }
    return found;
}

swing_dynamics dynamics_of(const filtered_samples& link, const filtered_samples& motor,
                           const std::vector<soft_transmission>& soft, const links_torque& torque) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    std::vector<int> joints;
    for (const soft_transmission& t : soft) {
        joints.push_back(t.joint);
    }
    filtered_samples probe = link;
    probe.qdd = motor.qdd;
    swing_dynamics found{torque(probe)(Eigen::all, joints), Eigen::MatrixXd(motor.samples(), s * s)};
    for (Eigen::Index i = 0; i < s; ++i) {
        const int joint = joints[static_cast<std::size_t>(i)];
        probe.qdd.col(joint).array() += 1.0;
        found.inertia.middleCols(i * s, s) = torque(probe)(Eigen::all, joints) - found.forcing;
        probe.qdd.col(joint) = motor.qdd.col(joint);
    }
    return found;
}

}  // namespace

twist_motion swing(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate) {
    if (soft.size() == 1) {
        return swing_of_one(dynamics, soft.front(), rate);
    }
    const auto s = static_cast<Eigen::Index>(soft.size());
    const Eigen::Index n = dynamics.forcing.rows();
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(n, s);
    twist_motion found{none, none, none};
    if (n < shortest_motion || !(dynamics.inertia.row(0).reshaped(s, s).diagonal().minCoeff() > 0.0)) {
        return found;
    }
    Eigen::VectorXd from = dynamics.forcing.row(0);
    auto [angle, twist_rate] = slow_start(dynamics, soft, rate);
    Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(s);
    swing_modes modes(soft);
    for (Eigen::Index k = 0; k < n; ++k) {
        if (k > 0) {
            const Eigen::VectorXd between = 0.5 * (dynamics.inertia.row(k - 1) + dynamics.inertia.row(k));
            if (!modes.take(between.reshaped(s, s))) {
                return {none, none, none};
            }
            const Eigen::VectorXd to = dynamics.forcing.row(k);
            modes.move(1.0 / rate, from, to, angle, twist_rate, acceleration);
            from = to;
        }
        found.angle.row(k) = angle;
        found.rate.row(k) = twist_rate;
        found.acceleration.row(k) = acceleration;
    }
    return found;
}

// The inertia stands on the left of the equation of the twist: what is left for the next step is that gravity and
// velocities act on the links where they are, a hundredth of the stiffness or less.
filtered_samples links_behind(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                              const links_torque& torque) {
    constexpr int most_steps = 30;
    constexpr double settled = 1e-11;
    filtered_samples link = motor;
    double change = soft.empty() ? 0.0 : 1.0;
    for (int step = 0; step < most_steps && change > settled; ++step) {
        const twist_motion twist = swing(dynamics_of(link, motor, soft, torque), soft, motor.rate);
        const Eigen::MatrixXd before = link.q;
        for (std::size_t i = 0; i < soft.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            const int j = soft[i].joint;
            link.q.col(j) = motor.q.col(j) - twist.angle.col(column);
            link.qd.col(j) = motor.qd.col(j) - twist.rate.col(column);
            link.qdd.col(j) = motor.qdd.col(j) - twist.acceleration.col(column);
        }
        change = (link.q - before).cwiseAbs().maxCoeff() / std::max(1.0, motor.q.cwiseAbs().maxCoeff());
        if (!link.q.allFinite() || !link.qdd.allFinite()) {
            return motor;
        }
    }
    return link;
}

}  // namespace idim
