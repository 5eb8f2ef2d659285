#include "undeclared/declared_span.hpp"

#include <cmath>
#include <numbers>

#include "undeclared/rigid_body_engine.hpp"

namespace idim::undeclared {

namespace {

using std::numbers::pi;

constexpr double cutoff = 15.0;  // [Hz]

/// Butterworth low-pass of order 4, run over the columns of a table forward and backward.
class zero_phase_low_pass {
  public:
    zero_phase_low_pass(double corner, double rate) : c_(std::tan(pi * corner / rate)) {}

    Eigen::MatrixXd filtered(Eigen::MatrixXd table) const {
        for (auto column : table.colwise()) {
            for (const double angle : {pi / 8.0, 3.0 * pi / 8.0}) {
                run(column, 2.0 * std::cos(angle), false);
                run(column, 2.0 * std::cos(angle), true);
            }
        }
        return table;
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

/// From the log's rate in two steps: well above the cut-off, where columns are computed, and then at it.
class row_chain {
  public:
    explicit row_chain(double rate)
        : stride_(std::max<Eigen::Index>(1, static_cast<Eigen::Index>(rate / (12.0 * cutoff)))),
          first_(std::min(4.0 * cutoff, 0.4 * rate), rate),
          second_(cutoff, rate / static_cast<double>(stride_)),
          thinning_(std::max<Eigen::Index>(
              1, static_cast<Eigen::Index>(rate / static_cast<double>(stride_) / (2.5 * cutoff)))),
          ends_(static_cast<Eigen::Index>(rate / static_cast<double>(stride_) / cutoff)) {}

    /// Every signal of the log that is not computed at the lower rate.
    Eigen::MatrixXd slowed(const Eigen::MatrixXd& signals) const { return every(first_.filtered(signals), stride_); }
    Eigen::MatrixXd smooth(const Eigen::MatrixXd& signals) const { return first_.filtered(signals); }
    Eigen::MatrixXd thinned(const Eigen::MatrixXd& slow) const {
        return every(second_.filtered(slow).middleRows(ends_, slow.rows() - 2 * ends_), thinning_);
    }
    Eigen::Index stride() const { return stride_; }

  private:
    static Eigen::MatrixXd every(const Eigen::MatrixXd& table, Eigen::Index stride) {
        return table(Eigen::seq(0, table.rows() - 1, stride), Eigen::all);
    }

    Eigen::Index stride_;
    zero_phase_low_pass first_, second_;
    Eigen::Index thinning_, ends_;
};

struct smooth_motion {
    Eigen::MatrixXd q, qd, qdd;
};

/// Central differences; the two ends are at rest and their rows are left out later.
smooth_motion differentiated(const Eigen::MatrixXd& q, double rate) {
    smooth_motion motion{q, Eigen::MatrixXd::Zero(q.rows(), q.cols()), Eigen::MatrixXd::Zero(q.rows(), q.cols())};
    const Eigen::Index inner = q.rows() - 2;
    const auto before = q.topRows(inner), after = q.bottomRows(inner);
    motion.qd.middleRows(1, inner) = (after - before) * (0.5 * rate);
    motion.qdd.middleRows(1, inner) = (after - 2.0 * q.middleRows(1, inner) + before) * (rate * rate);
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

/// Rows of one sample's joints after another's.
Eigen::VectorXd stacked(const Eigen::MatrixXd& table) {
    return table.transpose().reshaped();
}

class column_table {
  public:
    column_table(const arm& robot, const declaration& declared, const smooth_motion& motion, const row_chain& chain)
        : chain_(chain), dof_(robot.dof()) {
        add_links(robot, motion);
        for (int j = 0; j < dof_; ++j) {
            const std::size_t i = static_cast<std::size_t>(j);
            add_joint(j, declared.rotor[i], motion.qdd.col(j));
            add_joint(j, declared.viscous[i], motion.qd.col(j));
            add_joint(j, declared.coulomb[i], motion.qd.col(j).cwiseSign());
            add_joint(j, declared.offset[i], Eigen::VectorXd::Ones(motion.q.rows()));
        }
    }

    Eigen::MatrixXd W() const {
        Eigen::MatrixXd table(columns_.front().size(), static_cast<Eigen::Index>(columns_.size()));
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            table.col(static_cast<Eigen::Index>(i)) = columns_[i];
        }
        return table;
    }

  private:
    void add_links(const arm& robot, const smooth_motion& motion) {
        const std::vector<solid> bodies = independent_bodies();
        const Eigen::Index stride = chain_.stride(), count = (motion.q.rows() - 1) / stride + 1;
        rigid_body_engine engine(robot);
        for (int j = 0; j < dof_; ++j) {
            engine.set_link(j, {});
        }
        Eigen::MatrixXd torque(count, dof_);
        Eigen::VectorXd tau;
        for (int j = 0; j < dof_; ++j) {
            for (const solid& body : bodies) {
                engine.set_link(j, body);
                for (Eigen::Index k = 0; k < count; ++k) {
                    const Eigen::Index row = k * stride;
                    engine.inverse_dynamics(motion.q.row(row), motion.qd.row(row), motion.qdd.row(row), tau);
                    torque.row(k) = tau;
                }
                columns_.push_back(stacked(chain_.thinned(torque)));
            }
            engine.set_link(j, {});
        }
    }

    void add_joint(int joint, bool there, const Eigen::VectorXd& signal) {
        if (there) {
            const Eigen::MatrixXd slow = chain_.slowed(signal);
            Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(slow.rows(), dof_);
            torque.col(joint) = slow;
            columns_.push_back(stacked(chain_.thinned(torque)));
        }
    }

    const row_chain& chain_;
    int dof_;
    std::vector<Eigen::VectorXd> columns_;
};

Eigen::VectorXd root_mean_square(const Eigen::VectorXd& rows, Eigen::Index dof) {
    const Eigen::Index count = rows.size() / dof;
    return (rows.reshaped(dof, count).rowwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt();
}

}  // namespace

declared_span::declared_span(const arm& robot, const declaration& declared, const recording& made)
    : rate_(1.0 / (made.t[1] - made.t[0])) {
    const row_chain chain(rate_);
    const smooth_motion motion = differentiated(chain.smooth(made.q), rate_);
    const Eigen::MatrixXd speed = chain.thinned(chain.slowed(motion.qd)).cwiseAbs();
    const Eigen::RowVectorXd rest = 0.01 * speed.colwise().maxCoeff();
    moves_ = stacked((speed.array() > rest.array().replicate(speed.rows(), 1)).cast<double>().matrix());
    W_ = moves_.asDiagonal() * column_table(robot, declared, motion, chain).W();
    const Eigen::VectorXd Y = rows_of(made.tau - made.effect);
    const int n = robot.dof();
    decompose(root_mean_square(Y, n));
    decompose(root_mean_square(outside(Y), n));
    residual_ = root_mean_square(outside(Y), n);
}

Eigen::VectorXd declared_span::rows_of(const Eigen::MatrixXd& signals) const {
    const row_chain chain(rate_);
    return moves_.cwiseProduct(stacked(chain.thinned(chain.slowed(signals))));
}

/// Columns of unit length; directions below 1e-7 of the largest are rounding.
void declared_span::decompose(const Eigen::VectorXd& weight) {
    inverse_weight_ = weight.cwiseInverse().replicate(W_.rows() / weight.size(), 1);
    Eigen::MatrixXd scaled = inverse_weight_.asDiagonal() * W_;
    for (auto column : scaled.colwise()) {
        column /= std::max(column.norm(), 1e-12);
    }
    qr_.setThreshold(1e-7);
    qr_.compute(scaled);
}

Eigen::VectorXd declared_span::outside(const Eigen::VectorXd& y) const {
    Eigen::VectorXd rest = inverse_weight_.cwiseProduct(y);
    rest.applyOnTheLeft(qr_.householderQ().transpose());
    rest.head(qr_.rank()).setZero();
    rest.applyOnTheLeft(qr_.householderQ());
    return rest.cwiseQuotient(inverse_weight_);
}

effect_strength declared_span::strength_of(const recording& made) const {
    const Eigen::VectorXd E = rows_of(made.effect);
    const Eigen::Index n = made.effect.cols();
    return {root_mean_square(outside(E), n), residual_, root_mean_square(E, n)};
}

}  // namespace idim::undeclared
