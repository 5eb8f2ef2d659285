// Links behind soft transmissions, against closed forms and a simulation of the link in fine steps.
#include "links_behind.hpp"
#include "swing_start.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <complex>

namespace {

using complex = std::complex<double>;
using idim::filtered_samples;

constexpr double swing_rate = 1000.0;  // samples a second

/// The swing that starts as a slow motion would.
idim::twist_motion swing_slowly_started(const idim::swing_dynamics& dynamics,
                                        const std::vector<idim::soft_transmission>& soft) {
    return idim::swing(dynamics, soft, swing_rate, idim::slow_start(dynamics, soft, swing_rate));
}

/// A forcing of the links, F cos(w t + phase), along the samples.
Eigen::MatrixXd swinging_forcing(const Eigen::VectorXd& amplitude, double w, Eigen::Index samples) {
    Eigen::MatrixXd forcing(samples, amplitude.size());
    for (Eigen::Index k = 0; k < samples; ++k) {
        forcing.row(k) = amplitude.transpose() * std::cos(w * static_cast<double>(k) / swing_rate);
    }
    return forcing;
}

/// Largest distance of the twist from the stationary one over its size, in the last half of the samples.
double distance_from_response(const Eigen::MatrixXd& M, const Eigen::VectorXd& K, const Eigen::VectorXd& D, double f) {
    constexpr Eigen::Index samples = 16000;  // what swings freely at first is gone by the middle, to e^-14
    const double w = 2.0 * M_PI * f;
    const Eigen::VectorXd amplitude = Eigen::VectorXd::LinSpaced(K.size(), 3.0, 5.0);
    std::vector<idim::soft_transmission> soft;
    for (Eigen::Index i = 0; i < K.size(); ++i) {
        soft.push_back({static_cast<int>(i), K[i], D[i]});
    }
    const Eigen::VectorXd flat = M.reshaped();
    const idim::twist_motion twist =
        swing_slowly_started({swinging_forcing(amplitude, w, samples), flat.transpose().replicate(samples, 1)}, soft);

    Eigen::MatrixXcd stiffness = -w * w * M.cast<complex>();
    stiffness.diagonal() += K.cast<complex>() + complex(0.0, w) * D.cast<complex>();
    const Eigen::VectorXcd response = stiffness.partialPivLu().solve(amplitude.cast<complex>());
    double worst = 0.0;
    for (Eigen::Index k = samples / 2; k < samples; ++k) {
        const complex turn = std::exp(complex(0.0, w * static_cast<double>(k) / swing_rate));
        const double angle = (twist.angle.row(k).transpose() - (turn * response).real()).norm();
        const double speed = (twist.rate.row(k).transpose() - (complex(0.0, w) * turn * response).real()).norm();
        const double acceleration = (twist.acceleration.row(k).transpose() + (w * w * turn * response).real()).norm();
        worst = std::max(
            {worst, angle / response.norm(), speed / (w * response.norm()), acceleration / (w * w * response.norm())});
    }
    return worst;
}

// The forcing goes straight from sample to sample, by which a cosine of w loses (w h)^2 / 12 of its amplitude and gains
// as much again in harmonics of the sampling: 3e-4 at 10 Hz, 8e-3 at 50 Hz.
TEST(LinkSwing, RespondsBelowAtAndAboveItsResonance) {
    const Eigen::MatrixXd M = Eigen::MatrixXd::Constant(1, 1, 0.8);
    const Eigen::VectorXd K = Eigen::VectorXd::Constant(1, 0.8 * std::pow(2.0 * M_PI * 10.0, 2));
    const Eigen::VectorXd D = Eigen::VectorXd::Constant(1, 2.0 * 0.05 * std::sqrt(0.8 * K[0]));
    EXPECT_LT(distance_from_response(M, K, D, 3.0), 1e-3);
    EXPECT_LT(distance_from_response(M, K, D, 10.0), 1e-3);
    EXPECT_LT(distance_from_response(M, K, D, 25.0), 5e-3);
}

TEST(LinkSwing, RespondsWhereItIsDampedMoreThanCritically) {
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
    EXPECT_LT(distance_from_response(one, 900.0 * one, 200.0 * one, 5.0), 1e-3);
}

TEST(LinkSwing, TakesCoupledLinksTogether) {
    Eigen::Matrix2d M;
    M << 2.0, 0.5, 0.5, 0.4;
    const Eigen::Vector2d K(4000.0, 1500.0);
    EXPECT_LT(distance_from_response(M, K, 2e-3 * K, 4.0), 1e-3);   // both modes damped in proportion: exact
    EXPECT_LT(distance_from_response(M, K, 2e-3 * K, 11.0), 2e-3);  // modes at 6.9 and 10.9 Hz
}

TEST(LinkSwing, IsAtRestBehindAStiffTransmission) {
    constexpr Eigen::Index samples = 200;
    const Eigen::MatrixXd forcing = swinging_forcing(Eigen::VectorXd::Constant(1, 7.0), 30.0, samples);
    const idim::twist_motion twist =
        swing_slowly_started({forcing, Eigen::MatrixXd::Constant(samples, 1, 0.1)}, {{0, 1e9, 0.0}});
    EXPECT_LT((twist.angle * 1e9 - forcing).cwiseAbs().maxCoeff(), 1e-4 * 7.0);
}

TEST(LinkSwing, DoesNotHappenWithoutInertia) {
    const Eigen::MatrixXd forcing = Eigen::MatrixXd::Ones(50, 1);
    Eigen::MatrixXd inertia = Eigen::MatrixXd::Constant(50, 1, 0.5);
    inertia(30, 0) = -0.1;
    EXPECT_TRUE(swing_slowly_started({forcing, inertia}, {{0, 100.0, 1.0}}).angle.isZero(0.0));
}

/// A pendulum at the end of a soft transmission: M q'' + m g l cos q = K (th - q) + D (th' - q').
struct soft_pendulum {
    double M = 0.6, gravity = 8.0, K = 1500.0, D = 1.2;

    static double motor(double t) { return 0.6 * std::sin(2.0 * t) + 0.1 * std::sin(19.0 * t); }
    static double motor_speed(double t) { return 1.2 * std::cos(2.0 * t) + 1.9 * std::cos(19.0 * t); }
    static double motor_acceleration(double t) { return -2.4 * std::sin(2.0 * t) - 36.1 * std::sin(19.0 * t); }

    void operator()(const std::array<double, 2>& x, std::array<double, 2>& rate, double t) const {
        rate[0] = x[1];
        rate[1] = (K * (motor(t) - x[0]) + D * (motor_speed(t) - x[1]) - gravity * std::cos(x[0])) / M;
    }
};

class SoftPendulum : public testing::Test {
  protected:
    SoftPendulum() {
        motor_.rate = swing_rate;
        motor_.t = Eigen::VectorXd::LinSpaced(samples, 0.0, (samples - 1) / swing_rate);
        motor_.q = motor_.t.unaryExpr(&soft_pendulum::motor);
        motor_.qd = motor_.t.unaryExpr(&soft_pendulum::motor_speed);
        motor_.qdd = motor_.t.unaryExpr(&soft_pendulum::motor_acceleration);
    }

    Eigen::MatrixXd torque(const filtered_samples& at) const {
        return pendulum_.M * at.qdd + pendulum_.gravity * at.q.array().cos().matrix();
    }

    /// The motion of the link, simulated from this position and speed.
    Eigen::VectorXd simulated(double q, double qd) const {
        std::array<double, 2> x = {q, qd};
        Eigen::VectorXd motion = Eigen::VectorXd::Constant(samples, q);
        for (Eigen::Index k = 1; k < samples; ++k) {
            boost::numeric::odeint::integrate_n_steps(boost::numeric::odeint::runge_kutta4<std::array<double, 2>>(),
                                                      pendulum_, x, motor_.t[k - 1], 0.1 / swing_rate, 10);
            motion[k] = x[0];
        }
        return motion;
    }

    filtered_samples links(const idim::lacking_torque& lacking = {}) const {
        return idim::links_behind(
            motor_, {{0, pendulum_.K, pendulum_.D}}, [&](const filtered_samples& at) { return torque(at); }, lacking);
    }

    static constexpr Eigen::Index samples = 5000;
    soft_pendulum pendulum_;
    filtered_samples motor_;
};

// (w h)^2 / 12 of each part of the forcing is lost, which the resonance enlarges.
TEST_F(SoftPendulum, IsFollowedAsItIsSimulated) {
    const filtered_samples link = links();
    EXPECT_GT((link.q - motor_.q).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_LT((link.q - simulated(link.q(0, 0), link.qd(0, 0))).cwiseAbs().maxCoeff(),
              2e-3 * (link.q - motor_.q).cwiseAbs().maxCoeff());
}

TEST_F(SoftPendulum, StartsAsTheTorqueOfItsMotorTells) {
    const Eigen::VectorXd truth = simulated(motor_.q(0, 0), motor_.qd(0, 0));  // not twisted, for all its weight
    const double twist = (truth - motor_.q).cwiseAbs().maxCoeff();
    EXPECT_GT((links().q - truth).cwiseAbs().maxCoeff(), 0.1 * twist);
    const idim::lacking_torque lacking = [&](const filtered_samples& motors, const filtered_samples& at) {
        const Eigen::Index n = motors.samples();
        Eigen::MatrixXd carried(n, 1);  // K twist + D twist', its rate by central differences
        for (Eigen::Index k = 0; k < n; ++k) {
            const double speed = k > 0 ? 0.5 * swing_rate * (truth[k + 1] - truth[k - 1]) : motors.qd(0, 0);
            carried(k, 0) = pendulum_.K * (motors.q(k, 0) - truth[k]) + pendulum_.D * (motors.qd(k, 0) - speed);
        }
        return Eigen::MatrixXd(carried - torque(at));
    };
    EXPECT_LT((links(lacking).q - truth).cwiseAbs().maxCoeff(), 5e-3 * twist);
}

}  // namespace
