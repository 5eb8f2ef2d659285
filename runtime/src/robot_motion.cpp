#include "robot_motion.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

#include "idim/joint_space.hpp"

namespace idim {

namespace {

// A frozen joint is evaluated at least this fast on its side, so that sign() of the model keeps its value while the
// stages of a step overshoot zero; far below any speed that another term would notice.
constexpr double slowest = 1e-12;

constexpr double swing_per_step = 0.1;  // rad of the fastest swing in a step of rk4: 1e-7 of its amplitude in each
constexpr double fastest_swing = 1e6;   // rad/s: no transmission swings like that

constexpr const char* indefinite =
    "simulation at t = {:.4f} s: the inertia matrix is not positive definite at joint {}; the parameters are not "
    "physical";
constexpr const char* open_loops =
    "simulation at t = {:.4f} s, joint {}: the loops do not close at these positions; keep the reference where they do";
constexpr const char* no_inertia =
    "simulation at t = {:.4f} s, joint {}: joint_elasticity without inertia of the motor or of the link; expected a "
    "rotor "
    "inertia above zero";
constexpr const char* diverging =
    "simulation diverges at t = {:.4f} s, joint {}: lower the bandwidth or raise the rate of the control law";

}  // namespace

robot_motion::robot_motion(const idim_model_interface& model, const Eigen::VectorXd& chi,
                           const integration_options& options, const Eigen::VectorXd& q, const Eigen::VectorXd& qd)
    : model_(model),
      chi_(chi),
      options_(options),
      soft_(model, chi),
      n_(model.dof),
      size_(n_ + (options.rigid_transmissions ? 0 : soft_.count())),
      signals_(Eigen::VectorXd::Zero(std::max(model.dof, model.n_signals))),
      tau_(Eigen::VectorXd::Zero(n_)),
      N_(n_),
      holding_(n_),
      speed_(qd),
      link_speed_(qd),
      x_(2 * static_cast<std::size_t>(size_)),
      side_(static_cast<std::size_t>(n_), side::open),
      controlled_(controller::error_checker_type(options.tolerance, options.tolerance)) {
    place(q, qd);
    signals_.head(n_).setConstant(20.0);  // degC
    update_states(0.0, 0.0);
    for (int j = 0; j < n_; ++j) {
        const bool frozen = options.friction == friction_handling::located && has_jump(j);
        jumps_.push_back(frozen);
        side_[static_cast<std::size_t>(j)] =
            !frozen ? side::open : (qd[j] < 0.0 ? side::backward : (qd[j] > 0.0 ? side::forward : side::rest));
    }
}

/// Starts with the motors at q and qd, the links where they rest behind them.
void robot_motion::place(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    for (int j = 0; j < n_; ++j) {
        motor_.push_back(j);
    }
    Eigen::VectorXd link = q;
    if (is_soft()) {
        for (Eigen::Index k = 0; k < soft_.count(); ++k) {
            const int joint = soft_.joints()[static_cast<std::size_t>(k)];
            motor_[static_cast<std::size_t>(joint)] = static_cast<int>(n_ + k);
            x_[static_cast<std::size_t>(n_ + k)] = q[joint];
            x_[static_cast<std::size_t>(size_ + n_ + k)] = qd[joint];
        }
        link = soft_.links_at_rest(q, 0.0);
        const double swing = soft_.fastest_swing(link);
        if (!(swing < fastest_swing)) {
            fail(0.0, soft_.joints().front(), no_inertia);
        }
        longest_step_ = std::min(longest_step_, swing_per_step / swing);
    }
    std::copy(link.data(), link.data() + n_, x_.begin());
    std::copy(qd.data(), qd.data() + n_, x_.begin() + size_);
}

Eigen::VectorXd robot_motion::of_motors(const double* coordinates) const {
    Eigen::VectorXd result(n_);
    for (Eigen::Index j = 0; j < n_; ++j) {
        result[j] = coordinates[motor_[static_cast<std::size_t>(j)]];
    }
    return result;
}

/// States of effects after `dt`, or as a motion starts where it is 0.
void robot_motion::update_states(double t, double dt) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n_);
    if (signals_.size() >= n_ + model_.n_states + 2 * n_) {
        signals_.segment(n_ + model_.n_states, n_) = q();
        signals_.segment(2 * n_ + model_.n_states, n_) = qd();
    }
    if (model_.n_states == 0) {
        return;
    }
    Eigen::VectorXd states(model_.n_states);
    if (dt > 0.0) {
        model_.next_states(x_.data(), x_.data() + size_, none.data(), t, signals_.data(), dt, states.data());
    } else {
        model_.first_states(x_.data(), x_.data() + size_, none.data(), t, signals_.data(), states.data());
    }
    signals_.segment(n_, model_.n_states) = states;
}

/// Torque that joint j has beside its acceleration at the given speed, all others as frozen.
double robot_motion::bias_of(int joint, double speed, double t) {
    const double kept = speed_[joint];
    speed_[joint] = speed;
    model_.bias(x_.data(), speed_.data(), t, signals_.data(), chi_.data(), N_.data());
    speed_[joint] = kept;
    return N_[joint];
}

bool robot_motion::has_jump(int joint) {
    const double low = bias_of(joint, -slowest, 0.0);
    const double high = bias_of(joint, slowest, 0.0);
    return std::abs(high - low) > 1e-9 * std::max(1e-3, std::abs(high) + std::abs(low));
}

void robot_motion::freeze(const double* speeds) {
    const Eigen::VectorXd qd = of_motors(speeds);
    for (Eigen::Index j = 0; j < n_; ++j) {
        const side where = side_[static_cast<std::size_t>(j)];
        switch (where) {
            case side::open:
                speed_[j] = qd[j];
                break;
            case side::rest:
                speed_[j] = 0.0;
                break;
            default:
                speed_[j] = where == side::forward ? std::max(qd[j], slowest) : std::min(qd[j], -slowest);
        }
    }
}

bool robot_motion::any_rest() const {
    return std::find(side_.begin(), side_.end(), side::rest) != side_.end();
}

/// Friction linear in the speed between -band and band: what the model's own N has too much there goes to the torque.
void robot_motion::regularised_acceleration(const double* q, double t, double* qdd) {
    const Eigen::VectorXd real = of_motors(q + size_);
    const auto bias = [&](Eigen::VectorXd& N) {
        model_.bias(q, speed_.data(), t, signals_.data(), chi_.data(), N.data());
    };
    speed_ = (real.array().abs() < options_.band).select(0.0, real);
    Eigen::VectorXd at_zero(n_);
    bias(at_zero);
    Eigen::VectorXd tau = tau_;
    for (Eigen::Index j = 0; j < n_; ++j) {
        if (std::abs(real[j]) < options_.band && real[j] != 0.0) {
            speed_[j] = std::copysign(options_.band, real[j]);
            bias(N_);
            speed_[j] = 0.0;
            tau -= (N_ - at_zero) * (std::abs(real[j]) / options_.band);
        }
    }
    free_acceleration(q, t, tau, qdd);
}

/// Accelerations of all coordinates at the frozen speeds; `q` is a state, speeds behind positions.
void robot_motion::free_acceleration(const double* q, double t, const Eigen::VectorXd& tau, double* qdd) {
    if (is_soft()) {
        link_speed_ = speed_;
        for (const int j : soft_.joints()) {
            link_speed_[j] = q[size_ + j];
        }
        if (!soft_.accelerations({q, link_speed_, of_motors(q), speed_, tau, t, signals_}, qdd)) {
            fail(t, soft_.joints().front(), no_inertia);
            std::fill(qdd, qdd + size_, 0.0);
        }
        return;
    }
    const int joint = model_.forward_dynamics(q, speed_.data(), tau.data(), t, signals_.data(), chi_.data(), qdd);
    if (joint != 0) {
        fail(t, std::clamp<int>(joint, 1, model_.dof) - 1, loops_close(model_, q) ? indefinite : open_loops);
        std::fill(qdd, qdd + n_, 0.0);
    }
}

/// The torques that keep resting joints where they are: M qdd + N + holding = tau, with qdd = 0 where a joint rests and
/// holding = 0 elsewhere. Newton's method on the direct model, which is affine in the torque but for effects of the
/// load.
void robot_motion::held_acceleration(const double* q, double t, double* qdd) {
    std::vector<Eigen::Index> joints;
    for (Eigen::Index j = 0; j < n_; ++j) {
        if (side_[static_cast<std::size_t>(j)] == side::rest) {
            joints.push_back(j);
        }
    }
    Eigen::VectorX<Eigen::Index> rest(static_cast<Eigen::Index>(joints.size()));  // their coordinates
    std::transform(joints.begin(), joints.end(), rest.data(),
                   [this](Eigen::Index j) { return motor_[static_cast<std::size_t>(j)]; });
    Eigen::Map<Eigen::VectorXd> result(qdd, size_);
    Eigen::VectorXd moved(size_);
    Eigen::MatrixXd slope(rest.size(), rest.size());
    free_acceleration(q, t, tau_, qdd);
    for (std::size_t k = 0; k < joints.size(); ++k) {
        Eigen::VectorXd more = tau_;
        more[joints[k]] += 1.0;
        free_acceleration(q, t, more, moved.data());
        slope.col(static_cast<Eigen::Index>(k)) = (moved - result)(rest);
    }
    holding_.setZero();
    if (failure_) {
        return;
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
    constexpr int most = 4;
    for (int i = 0; i < most && result(rest).norm() > 1e-12 * (1.0 + result.norm()); ++i) {
        const Eigen::VectorXd correction = factors.solve(Eigen::VectorXd(result(rest)));
        for (std::size_t k = 0; k < joints.size(); ++k) {
            holding_[joints[k]] += correction[static_cast<Eigen::Index>(k)];
        }
        free_acceleration(q, t, tau_ - holding_, qdd);
    }
    result(rest).setZero();
}

void robot_motion::derivative(const state& x, state& dxdt, double t) {
    const double* const q = x.data();
    const double* const qd = x.data() + size_;
    double* const qdd = dxdt.data() + size_;
    std::copy(qd, qd + size_, dxdt.begin());
    if (options_.friction == friction_handling::regularised) {
        regularised_acceleration(q, t, qdd);
        return;
    }
    freeze(qd);
    if (any_rest()) {
        held_acceleration(q, t, qdd);
    } else {
        free_acceleration(q, t, tau_, qdd);
    }
}

/// Lets go the resting joint whose friction is exceeded most; false where all hold.
bool robot_motion::release_one(double t) {
    state rate(x_.size());
    derivative(x_, rate, t);
    const Eigen::VectorXd holding = holding_;
    double worst = 0.0;
    int released = -1;
    side direction = side::rest;
    for (int j = 0; j < n_; ++j) {
        if (side_[static_cast<std::size_t>(j)] != side::rest) {
            continue;
        }
        const double middle = bias_of(j, 0.0, t);
        const double above = holding[j] - (bias_of(j, slowest, t) - middle);
        const double below = (bias_of(j, -slowest, t) - middle) - holding[j];
        const double excess = std::max(above, below);
        if (excess > worst) {
            worst = excess;
            released = j;
            direction = above > below ? side::forward : side::backward;
        }
    }
    if (released >= 0) {
        side_[static_cast<std::size_t>(released)] = direction;
        controlled_.reset();
    }
    return released >= 0;
}

/// Decides which of the resting joints friction can hold.
void robot_motion::settle(double t) {
    while (!failure_ && any_rest() && release_one(t)) {
    }
}

void robot_motion::plain_step(state& x, double t, double h) {
    const auto system = [this](const state& at, state& rate, double time) { derivative(at, rate, time); };
    if (options_.method == integrator::rk4) {
        rk4_.do_step(system, x, t, h);
    } else {
        dopri5_.reset();
        dopri5_.do_step(system, x, t, h);
    }
}

/// One step of at most h; returns its length, and leaves in h what the next may have.
double robot_motion::step(double t, double& h, double shortest) {
    if (options_.method == integrator::rk4) {
        plain_step(x_, t, h);
        return h;
    }
    const auto system = [this](const state& at, state& rate, double time) { derivative(at, rate, time); };
    double reached = t;
    while (controlled_.try_step(system, x_, reached, h) == boost::numeric::odeint::fail) {
        if (h < shortest) {  // across a jump no step is short enough for the tolerance
            h = shortest;
            plain_step(x_, t, h);
            controlled_.reset();
            return h;
        }
    }
    return reached - t;
}

double robot_motion::lowest_advance(const state& x, const std::vector<int>& joints) const {
    double lowest = INFINITY;
    for (const int j : joints) {
        lowest = std::min(lowest, static_cast<double>(side_[static_cast<std::size_t>(j)]) * speed(x, j));
    }
    return lowest;
}

/// Shortens the step from before_ to x_ to the first change of a frozen sign; returns the length that is left.
double robot_motion::locate(double t, double h) {
    std::vector<int> crossing;
    for (int j = 0; j < n_; ++j) {
        const auto at = static_cast<std::size_t>(j);
        const bool moves = side_[at] == side::forward || side_[at] == side::backward;
        if (moves && static_cast<double>(side_[at]) * speed(x_, j) < 0.0) {
            crossing.push_back(j);
        }
    }
    if (crossing.empty()) {
        return h;
    }
    // Regula falsi, Illinois variant (Dowell and Jarratt 1971): `high` stays beyond the change.
    double low = 0.0, high = h;
    double f_low = std::max(lowest_advance(before_, crossing), 0.0), f_high = lowest_advance(x_, crossing);
    int kept = 0;
    constexpr int most = 60;
    for (int i = 0; i < most && high - low > 1e-10 * h && f_high < -slowest; ++i) {
        const double middle = low + (high - low) * f_low / (f_low - f_high);
        trial_ = before_;
        plain_step(trial_, t, middle);
        const double f = lowest_advance(trial_, crossing);
        if (f >= 0.0) {
            f_high *= kept == 1 ? 0.5 : 1.0;
            low = middle;
            f_low = f;
            kept = 1;
        } else {
            f_low *= kept == -1 ? 0.5 : 1.0;
            high = middle;
            f_high = f;
            x_ = trial_;
            kept = -1;
        }
    }
    for (const int j : crossing) {
        const auto at = static_cast<std::size_t>(j);
        if (static_cast<double>(side_[at]) * speed(x_, j) <= 0.0) {
            x_[static_cast<std::size_t>(size_ + motor_[at])] = 0.0;
            const double jump = bias_of(j, slowest, t) - bias_of(j, -slowest, t);
            // Friction that drives (estimates on their way may have it) holds nothing: the joint passes.
            side_[at] = jump > 0.0 ? side::rest : (side_[at] == side::forward ? side::backward : side::forward);
        }
    }
    controlled_.reset();
    return high;
}

void robot_motion::fail(double t, int joint, const char* format) {
    if (!failure_) {
        failure_ = {t, joint, fmt::format(fmt::runtime(format), t, model_.joint_names[joint])};
    }
}

void robot_motion::check(double t) {
    constexpr double fastest = 1e4;  // rad/s or m/s: no robot moves like that
    for (Eigen::Index c = 0; c < size_; ++c) {
        if (!(std::abs(x_[static_cast<std::size_t>(size_ + c)]) < fastest)) {
            fail(t, c < n_ ? static_cast<int>(c) : soft_.joints()[static_cast<std::size_t>(c - n_)], diverging);
        }
    }
}

Eigen::VectorXd robot_motion::acceleration(double t, const Eigen::VectorXd& tau) {
    tau_ = tau;
    settle(t);
    state rate(x_.size());
    derivative(x_, rate, t);
    return of_motors(rate.data() + size_);
}

void robot_motion::advance(double t, double period, const Eigen::VectorXd& tau) {
    tau_ = tau;
    settle(t);
    controlled_.reset();
    const double steps = options_.substeps > 0 ? options_.substeps : std::ceil(period / longest_step_ - 1e-9);
    const double end = t + period;
    const double rounding = 1e-9 * period;
    double next = options_.method == integrator::rk4 ? period / steps : period;
    while (end - t > rounding && !failure_) {
        double h = std::min(options_.method == integrator::rk4 ? period / steps : next, end - t);
        before_ = x_;
        const double taken = step(t, h, 1e-6 * period);
        next = std::max(h, 1e-6 * period);
        const double moved = options_.friction == friction_handling::located ? locate(t, taken) : taken;
        t += moved;
        update_states(t, moved);
        check(t);
        settle(t);
    }
}

}  // namespace idim
