#include "undeclared/effect_strength.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "undeclared/rigid_body_engine.hpp"

namespace idim::undeclared {

namespace {

using std::numbers::pi;

/// Butterworth low-pass of order 4, run over the columns of a table forward and backward.
class zero_phase_low_pass {
  public:
    zero_phase_low_pass(double cutoff, double rate) : c_(std::tan(pi * cutoff / rate)) {}

    void filter(Eigen::MatrixXd& table) const {
        for (auto column : table.colwise()) {
            for (const double angle : {pi / 8.0, 3.0 * pi / 8.0}) {
                run(column, 2.0 * std::cos(angle), false);
                run(column, 2.0 * std::cos(angle), true);
            }
        }
    }

  private:
    /// One section of the bilinear transform of 1 / (s^2 + b s + 1), at rest at its first value.
    void run(Eigen::Ref<Eigen::VectorXd> x, double b, bool backward) const {
        const double norm = 1.0 / (1.0 + b * c_ + c_ * c_);
        const double gain = c_ * c_ * norm, a1 = 2.0 * (c_ * c_ - 1.0) * norm, a2 = (1.0 - b * c_ + c_ * c_) * norm;
        const Eigen::Index count = x.size();
        double x1 = x[backward ? count - 1 : 0], x2 = x1, y1 = x1, y2 = x1;
        for (Eigen::Index i = 0; i < count; ++i) {
            double& value = x[backward ? count - 1 - i : i];
            const double y = gain * (value + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
            x2 = x1;
            x1 = value;
            y2 = y1;
            y1 = y;
            value = y;
        }
    }

    double c_;
};

/// Filtered signals at every sample.
struct smooth_motion {
    Eigen::MatrixXd q, qd, qdd;
};

smooth_motion smooth(const Eigen::MatrixXd& measured, const zero_phase_low_pass& low_pass, double rate) {
    smooth_motion motion{measured, Eigen::MatrixXd::Zero(measured.rows(), measured.cols()), {}};
    low_pass.filter(motion.q);
    motion.qdd = motion.qd;
    const Eigen::Index inner = measured.rows() - 2;
    const auto before = motion.q.topRows(inner), after = motion.q.bottomRows(inner);
    motion.qd.middleRows(1, inner) = (after - before) * (0.5 * rate);
    motion.qdd.middleRows(1, inner) = (after - 2.0 * motion.q.middleRows(1, inner) + before) * (rate * rate);
    return motion;
}

/// Ten bodies whose inertial parameters are linearly independent.
std::vector<solid> independent_bodies() {
    sampler random("independent bodies", 1);
    std::vector<solid> bodies;
    for (int i = 0; i < 10; ++i) {
        bodies.push_back(random_solid(1.0, 0.5, random));
    }
    return bodies;
}

class column_table {
  public:
    column_table(const arm& robot, const declaration& declared, const smooth_motion& motion,
                 const zero_phase_low_pass& low_pass, const std::vector<Eigen::Index>& rows)
        : rows_(rows), W_(static_cast<Eigen::Index>(rows.size()) * robot.dof(), 14 * robot.dof()) {
        W_.setZero();
        add_links(robot, motion);
        for (int j = 0; j < robot.dof(); ++j) {
            const std::size_t i = static_cast<std::size_t>(j);
            add_joint(j, declared.rotor[i], motion.qdd.col(j));
            add_joint(j, declared.viscous[i], motion.qd.col(j));
            Eigen::MatrixXd sign = motion.qd.col(j).cwiseSign();
            low_pass.filter(sign);
            add_joint(j, declared.coulomb[i], sign);
            add_joint(j, declared.offset[i], Eigen::VectorXd::Ones(motion.q.rows()));
        }
        W_.conservativeResize(Eigen::NoChange, filled_);
    }

    const Eigen::MatrixXd& W() const { return W_; }

  private:
    void add_links(const arm& robot, const smooth_motion& motion) {
        const std::vector<solid> bodies = independent_bodies();
        const int n = robot.dof();
        rigid_body_engine engine(robot);
        for (int j = 0; j < n; ++j) {
            engine.set_link(j, {});
        }
        Eigen::VectorXd tau;
        for (int j = 0; j < n; ++j) {
            for (const solid& body : bodies) {
                engine.set_link(j, body);
                for (std::size_t k = 0; k < rows_.size(); ++k) {
                    const Eigen::Index row = rows_[k];
                    engine.inverse_dynamics(motion.q.row(row), motion.qd.row(row), motion.qdd.row(row), tau);
                    W_.col(filled_).segment(static_cast<Eigen::Index>(k) * n, n) = tau;
                }
                ++filled_;
            }
            engine.set_link(j, {});
        }
    }

    void add_joint(int joint, bool there, const Eigen::MatrixXd& signal) {
        if (!there) {
            return;
        }
        const Eigen::Index n = W_.cols() / 14;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            W_(static_cast<Eigen::Index>(k) * n + joint, filled_) = signal(rows_[k], 0);
        }
        ++filled_;
    }

    std::vector<Eigen::Index> rows_;
    Eigen::MatrixXd W_;
    Eigen::Index filled_ = 0;
};

/// Rows of one joint after another, sample by sample.
Eigen::VectorXd stacked(const Eigen::MatrixXd& table, const std::vector<Eigen::Index>& rows) {
    Eigen::VectorXd all(static_cast<Eigen::Index>(rows.size()) * table.cols());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        all.segment(static_cast<Eigen::Index>(k) * table.cols(), table.cols()) = table.row(rows[k]);
    }
    return all;
}

Eigen::VectorXd root_mean_square(const Eigen::VectorXd& all, Eigen::Index dof) {
    const Eigen::Index count = all.size() / dof;
    return (all.reshaped(dof, count).rowwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt();
}

/// What is left of `y` outside the span of W when the rows of joint j are divided by weight j.
Eigen::VectorXd outside_span(const Eigen::MatrixXd& W, const Eigen::VectorXd& y, const Eigen::VectorXd& weight) {
    const Eigen::VectorXd inverse = weight.cwiseInverse().replicate(y.size() / weight.size(), 1);
    Eigen::MatrixXd scaled = inverse.asDiagonal() * W;
    for (auto column : scaled.colwise()) {
        column /= std::max(column.norm(), 1e-12);
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
    qr.setThreshold(1e-7);
    Eigen::VectorXd rest = inverse.cwiseProduct(y);
    rest.applyOnTheLeft(qr.householderQ().transpose());
    rest.head(qr.rank()).setZero();
    rest.applyOnTheLeft(qr.householderQ());
    return rest.cwiseQuotient(inverse);
}

}  // namespace

effect_strength strength_of(const arm& robot, const declaration& declared, const recording& made, double cutoff) {
    const double rate = 1.0 / (made.t[1] - made.t[0]);
    const zero_phase_low_pass low_pass(cutoff, rate);
    const smooth_motion motion = smooth(made.q, low_pass, rate);
    std::vector<Eigen::Index> rows;
    const Eigen::Index stride = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(rate / (2.5 * cutoff)));
    const Eigen::Index ends = static_cast<Eigen::Index>(rate / cutoff);
    for (Eigen::Index k = ends; k < made.t.size() - ends; k += stride) {
        rows.push_back(k);
    }
    Eigen::MatrixXd tau = made.tau - made.effect, effect = made.effect;
    low_pass.filter(tau);
    low_pass.filter(effect);
    const column_table columns(robot, declared, motion, low_pass, rows);
    const Eigen::VectorXd Y = stacked(tau, rows), E = stacked(effect, rows);
    const int n = robot.dof();
    const Eigen::VectorXd even = root_mean_square(Y, n);
    const Eigen::VectorXd weight = root_mean_square(outside_span(columns.W(), Y, even), n);
    return {root_mean_square(outside_span(columns.W(), E, weight), n),
            root_mean_square(outside_span(columns.W(), Y, weight), n), root_mean_square(E, n)};
}

}  // namespace idim::undeclared
