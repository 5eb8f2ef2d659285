#pragma once

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <vector>

#include "idim/simulation.hpp"
#include "soft_transmissions.hpp"

namespace idim {

/// Position and velocity of a robot under torques that are held (integration_options). What encoders see and friction
/// acts on is the motion of the motors, which is that of the links but for soft transmissions.
class robot_motion {
  public:
    robot_motion(const idim_model_interface& model, const Eigen::VectorXd& chi, const integration_options& options,
                 const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

    /// Of the motors [n].
    Eigen::VectorXd q() const { return of_motors(x_.data()); }
    Eigen::VectorXd qd() const { return of_motors(x_.data() + size_); }
    /// [n] under tau, with the joints that rest settled for it.
    Eigen::VectorXd acceleration(double t, const Eigen::VectorXd& tau);
    /// Moves on by `period` under tau; stops where a failure happens.
    void advance(double t, double period, const Eigen::VectorXd& tau);

    const std::optional<simulation_failure>& failure() const { return failure_; }

  private:
    using state =
        std::vector<double>;  // positions of all coordinates [size_], then speeds: links [n], then soft motors
    using dopri5 = boost::numeric::odeint::runge_kutta_dopri5<state>;
    using controller = boost::numeric::odeint::controlled_runge_kutta<dopri5>;

    /// Side of its friction jump that a joint is on; `open` where nothing is frozen.
    enum class side : signed char { backward = -1, rest = 0, forward = 1, open = 2 };

    void place(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);
    bool is_soft() const { return size_ > n_; }
    Eigen::VectorXd of_motors(const double* coordinates) const;
    double speed(const state& x, int joint) const {
        return x[static_cast<std::size_t>(size_ + motor_[static_cast<std::size_t>(joint)])];
    }
    void update_states(double t, double dt);
    void derivative(const state& x, state& dxdt, double t);
    void free_acceleration(const double* q, double t, const Eigen::VectorXd& tau, double* qdd);
    void held_acceleration(const double* q, double t, double* qdd);
    void regularised_acceleration(const double* q, double t, double* qdd);
    void freeze(const double* speeds);
    double bias_of(int joint, double speed, double t);
    bool has_jump(int joint);
    void settle(double t);
    bool release_one(double t);
    bool any_rest() const;
    double step(double t, double& h, double shortest);
    void plain_step(state& x, double t, double h);
    double lowest_advance(const state& x, const std::vector<int>& joints) const;
    double locate(double t, double h);
    void check(double t);
    void fail(double t, int joint, const char* format);

    const idim_model_interface& model_;
    const Eigen::VectorXd& chi_;
    integration_options options_;
    soft_transmissions soft_;
    Eigen::Index n_, size_;
    std::vector<int> motor_;      // [n] coordinate of each motor
    double longest_step_ = 1e-3;  // s, of rk4
    Eigen::VectorXd signals_, tau_, N_, holding_;
    Eigen::VectorXd speed_;       // of the motors as friction sees it, frozen
    Eigen::VectorXd link_speed_;  // the same but for links behind soft transmissions
    state x_, before_, trial_;
    std::vector<side> side_;
    std::vector<bool> jumps_;
    boost::numeric::odeint::runge_kutta4<state> rk4_;
    dopri5 dopri5_;
    controller controlled_;
    std::optional<simulation_failure> failure_;
};

}  // namespace idim
