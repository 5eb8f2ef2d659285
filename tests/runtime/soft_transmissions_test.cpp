#include "soft_transmissions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "robot_motion.hpp"

namespace {

/// A link that gravity pulls behind a motor with Coulomb friction: chi = (J of the link, G, Ia, Fc). temp =
/// temperature, then position, speed and acceleration of the motor.
void rigid_torque(const double* q, const double*, const double* qdd, double, const double* chi, double* tau) {
    tau[0] = chi[0] * qdd[0] + chi[1] * std::cos(q[0]);
}

double rotor_friction(double speed, const double* chi) {
    return chi[3] * (static_cast<double>(speed > 0) - static_cast<double>(speed < 0));
}

void soft_inverse_dynamics(const double* q, const double* qd, const double* qdd, double t, const double* temp,
                           const double* chi, double* tau) {
    rigid_torque(q, qd, qdd, t, chi, tau);
    tau[0] += chi[2] * temp[3] + rotor_friction(temp[2], chi);
}

void soft_bias(const double* q, const double* qd, double, const double*, const double* chi, double* N) {
    N[0] = chi[1] * std::cos(q[0]) + rotor_friction(qd[0], chi);
}

const char* const soft_joint_names[] = {"arm"};
const int soft_joint_is_prismatic[] = {0};

class SoftJoint : public testing::Test {
  protected:
    SoftJoint() {
        model_.abi = IDIM_MODEL_ABI;
        model_.dof = 1;
        model_.n_base = 4;
        model_.n_signals = 4;
        model_.joint_names = soft_joint_names;
        model_.joint_is_prismatic = soft_joint_is_prismatic;
        model_.joint_stiffness = &stiffness_;
        model_.rigid_torque = rigid_torque;
        model_.inverse_dynamics = soft_inverse_dynamics;
        model_.bias = soft_bias;
    }

    idim::robot_motion at(double q, double qd, const idim::integration_options& options = {}) const {
        return {model_, chi_, options, Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, qd)};
    }

    double stiffness_ = 3000.0;
    idim_model_interface model_{};
    Eigen::VectorXd chi_ = Eigen::Vector4d(1.5, 0.0, 0.4, 0.0);
};

TEST_F(SoftJoint, SwingsAsTwoMassesOnASpringDo) {
    for (const auto method : {idim::integrator::rk4, idim::integrator::dopri5}) {
        idim::integration_options options;
        options.method = method;
        idim::robot_motion robot = at(0.0, 0.0, options);
        const double link = chi_[0], rotor = chi_[2], torque = 7.0, period = 1e-3;
        const double swing = std::sqrt(stiffness_ * (1.0 / link + 1.0 / rotor));
        const Eigen::VectorXd tau = Eigen::VectorXd::Constant(1, torque);
        for (int k = 0; k <= 500; ++k) {
            const double t = period * k;
            const double twist = torque / (rotor * swing * swing) * (1.0 - std::cos(swing * t));
            const double motor = 0.5 * torque * t * t / (link + rotor) + link / (link + rotor) * twist;
            ASSERT_NEAR(robot.q()[0], motor, 1e-7) << t;  // of 0.46 rad, of which the twist is 0.007
            robot.advance(t, period, tau);
        }
    }
}

TEST_F(SoftJoint, KeepsItsEnergyWithoutFriction) {
    chi_ << 1.5, 9.0, 0.4, 0.0;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
    idim::robot_motion robot = at(-0.3, 1.0);
    // The link is not seen from outside: it follows from the motor's acceleration, Ia thdd + K (th - q) = 0, its speed
    // from differences of that.
    const auto link = [&](double t) { return robot.q()[0] + chi_[2] * robot.acceleration(t, none)[0] / stiffness_; };
    const double period = 1e-4;
    double before = 0.0, here = link(0.0), first = 0.0, worst = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const double motor = robot.q()[0], speed = robot.qd()[0];
        robot.advance(period * k, period, none);
        const double after = link(period * (k + 1));
        if (k > 0) {
            const double rate = (after - before) / (2.0 * period);
            const double energy = 0.5 * chi_[0] * rate * rate + 0.5 * chi_[2] * speed * speed +
                                  0.5 * stiffness_ * std::pow(motor - here, 2) + chi_[1] * std::sin(here);
            first = k == 1 ? energy : first;
            worst = std::max(worst, std::abs(energy - first));
        }
        before = here;
        here = after;
    }
    EXPECT_LT(worst, 2e-5);  // of 7 J; central differences of a swing of 97 rad/s err by 1.6e-5 of its speed
}

TEST_F(SoftJoint, RestsTwistedByTheLoadWhereFrictionHoldsIt) {
    chi_ << 1.5, 9.0, 0.4, 20.0;
    idim::robot_motion robot = at(0.2, 0.0);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
    for (int k = 0; k < 1000; ++k) {
        robot.advance(1e-3 * k, 1e-3, none);
        ASSERT_NEAR(robot.q()[0], 0.2, 1e-12);
    }
    EXPECT_NEAR(robot.acceleration(1.0, none)[0], 0.0, 1e-9);
}

TEST_F(SoftJoint, WithoutRotorInertiaSaysWhatIsMissing) {
    chi_[2] = 0.0;
    const idim::robot_motion robot = at(0.0, 0.0);
    ASSERT_TRUE(robot.failure());
    EXPECT_NE(robot.failure()->message.find("rotor inertia above zero"), std::string::npos) << robot.failure()->message;
}

TEST_F(SoftJoint, StiffTransmissionMovesAsARigidOne) {
    stiffness_ = 1e6;
    chi_ << 1.5, 9.0, 0.4, 0.0;
    idim::robot_motion robot = at(-0.3, 0.0);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
    const double period = 1e-3;
    double q = -0.3, qd = 0.0;
    const auto rate = [&](double angle) { return -chi_[1] * std::cos(angle) / (chi_[0] + chi_[2]); };
    for (int k = 0; k < 300; ++k) {
        for (int i = 0; i < 10; ++i) {  // Stoermer and Verlet
            qd += 0.05 * period * rate(q);
            q += 0.1 * period * qd;
            qd += 0.05 * period * rate(q);
        }
        robot.advance(period * k, period, none);
    }
    EXPECT_NEAR(robot.q()[0], q, 3e-5);  // gravity twists the transmission by 1e-5
}

}  // namespace
