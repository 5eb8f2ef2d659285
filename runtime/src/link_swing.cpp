#include "link_swing.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace idim {

namespace {

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

    /// h >= 0 seconds on: the twist and its acceleration [s].
    void move(double h, const Eigen::VectorXd& from, const Eigen::VectorXd& to, twist_state& twist,
              Eigen::VectorXd& acceleration) const {
        Eigen::VectorXd x = to_modes_ * twist.angle;
        Eigen::VectorXd v = to_modes_ * twist.rate;
        Eigen::VectorXd a(x.size());
        const Eigen::VectorXd f0 = shapes_.transpose() * from;
        const Eigen::VectorXd f1 = shapes_.transpose() * to;
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            const mode& one = modes_[static_cast<std::size_t>(i)];
            if (h > 0.0) {
                one.move(h, f0[i], f1[i], x[i], v[i]);
            }
            a[i] = f1[i] - one.damping * v[i] - one.square * x[i];
        }
        twist = {shapes_ * x, shapes_ * v};
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

/// swing of one link, without matrices: a search tries many stiffnesses.
twist_motion swing_of_one(const swing_dynamics& dynamics, const soft_transmission& soft, double rate,
                          const twist_state& start) {
    const Eigen::Index n = dynamics.forcing.rows();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const auto F = dynamics.forcing.col(0);
    const auto M = dynamics.inertia.col(0);
    if (n == 0 || !(M.minCoeff() > 0.0)) {
        return {none, none, none};
    }
    twist_motion found{none, none, none};
    double angle = start.angle[0];
    double speed = start.rate[0];
    for (Eigen::Index k = 0; k < n; ++k) {
        const double inertia = 0.5 * (M[std::max<Eigen::Index>(k - 1, 0)] + M[k]);
        const mode one = damped({soft.damping / inertia, soft.stiffness / inertia});
        if (k > 0) {
            one.move(1.0 / rate, F[k - 1] / inertia, F[k] / inertia, angle, speed);
        }
        found.angle(k) = angle;
        found.rate(k) = speed;
        found.acceleration(k) = F[k] / inertia - one.damping * speed - one.square * angle;
    }
    return found;
}

}  // namespace

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

twist_motion swing(const swing_dynamics& dynamics, const std::vector<soft_transmission>& soft, double rate,
                   const twist_state& start) {
    if (soft.size() == 1) {
        return swing_of_one(dynamics, soft.front(), rate, start);
    }
    const auto s = static_cast<Eigen::Index>(soft.size());
    const Eigen::Index n = dynamics.forcing.rows();
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(n, s);
    twist_motion found{none, none, none};
    twist_state here = start;
    Eigen::VectorXd acceleration(s);
    swing_modes modes(soft);
    for (Eigen::Index k = 0; k < n; ++k) {
        const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0);
        const Eigen::VectorXd between = 0.5 * (dynamics.inertia.row(before) + dynamics.inertia.row(k));
        if (!modes.take(between.reshaped(s, s))) {
            return {none, none, none};
        }
        const double h = k > 0 ? 1.0 / rate : 0.0;
        modes.move(h, dynamics.forcing.row(before), dynamics.forcing.row(k), here, acceleration);
        found.angle.row(k) = here.angle;
        found.rate.row(k) = here.rate;
        found.acceleration.row(k) = acceleration;
    }
    return found;
}

}  // namespace idim
