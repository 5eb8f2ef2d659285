#include <gtest/gtest.h>

#include "idim/control_check.hpp"
#include "idim/emps_law.hpp"
#include "idim/p_position.hpp"
#include "idim/pd_cascade.hpp"
#include "idim/pid.hpp"
#include "support/one_joint.hpp"

namespace {

using idim::test::one;

idim::control_sample sample(double qr, double q, double qd = 0.0, double qdr = 0.0) {
    return {0.0, one(qr), one(qdr), one(0.0), one(q), one(qd)};
}

// All numbers below are exact in binary up to a few roundings.
constexpr double rounding = 1e-12;

TEST(ControlLaw, PdCascadeGivesItsEquation) {
    idim::pd_cascade law;
    law.rate = 100.0;
    law.drive_gain = one(3.0);
    law.kp = one(2.0);
    law.kv = one(5.0);
    // v = 5 (2 (1 - 0.25) - 0.5) = 5, tau = 15
    EXPECT_NEAR(law.torque(sample(1.0, 0.25, 0.5))[0], 15.0, rounding);
}

TEST(ControlLaw, PidSumsItsErrorButNotWhileLimited) {
    idim::pid law;
    law.rate = 10.0;
    law.drive_gain = one(1.0);
    law.kp = one(2.0);
    law.ki = one(10.0);
    law.kd = one(1.0);
    law.saturation = one(5.0);
    EXPECT_NEAR(law.command(sample(1.0, 0.0))[0], 3.0, rounding);       // 2*1 + 10*0.1
    EXPECT_NEAR(law.command(sample(1.0, 0.0, 1.0))[0], 3.0, rounding);  // 2*1 + 10*0.2 - 1
    EXPECT_NEAR(law.command(sample(4.0, 0.0))[0], 5.0, rounding);       // limited: the sum stays at 0.2
    EXPECT_NEAR(law.command(sample(0.0, 0.0))[0], 2.0, rounding);       // 10*0.2
    law.reset();
    EXPECT_NEAR(law.command(sample(1.0, 0.0))[0], 3.0, rounding);
}

TEST(ControlLaw, PositionLoopDrivesAVelocityLoop) {
    idim::p_position law;
    law.rate = 10.0;
    law.drive_gain = one(1.0);
    law.kp = one(4.0);
    law.kv = one(2.0);
    law.ki = one(5.0);
    law.kf = one(0.5);
    // w = 4*1 + 0.5*2 = 5; w - qd = 4: 2*4 + 5*0.4 = 10; then again 2*4 + 5*0.8 = 12
    EXPECT_NEAR(law.command(sample(1.0, 0.0, 1.0, 2.0))[0], 10.0, rounding);
    EXPECT_NEAR(law.command(sample(1.0, 0.0, 1.0, 2.0))[0], 12.0, rounding);
}

TEST(ControlLaw, EmpsTakesItsSpeedFromTheMeanOfTwoPositions) {
    idim::emps_law law;
    law.rate = 1000.0;
    law.drive_gain = one(35.0);
    law.kp = one(2.0);
    law.kv = one(3.0);
    EXPECT_NEAR(law.command(sample(1.0, 0.0))[0], 6.0, rounding);
    // f: 0, 0.0005, 0.0015 -> d = 0.5, 1.0
    EXPECT_NEAR(law.command(sample(1.001, 0.001))[0], 3.0 * (2.0 - 0.5), 1e-9);
    EXPECT_NEAR(law.command(sample(1.002, 0.002))[0], 3.0 * (2.0 - 1.0), 1e-9);
}

TEST(ControlLaw, DelayHoldsCommandsBackAndSaturationLimitsThem) {
    idim::pd_cascade law;
    law.rate = 100.0;
    law.drive_gain = one(2.0);
    law.kp = one(1.0);
    law.kv = one(1.0);
    law.saturation = one(4.0);
    law.delay = 2;
    const double errors[] = {1.0, 2.0, 9.0, -9.0, 0.0};
    const double expected[] = {0.0, 0.0, 2.0, 4.0, 8.0};  // g times the command two samples ago, at most 4
    for (int k = 0; k < 5; ++k) {
        EXPECT_NEAR(law.torque(sample(errors[k], 0.0))[0], expected[k], rounding) << k;
    }
}

TEST(ControlLaw, TuningFollowsTheInertiaAtTheSameBandwidth) {
    idim::pd_cascade law = idim::tune_pd_cascade(200.0, one(10.0), one(0.5), one(3.0), one(2.0));
    EXPECT_NEAR(law.kp[0], 10.0, rounding);
    EXPECT_NEAR(law.kv[0], 15.0, rounding);
    law.tune(one(6.0));
    EXPECT_NEAR(law.kp[0], 10.0, rounding);
    EXPECT_NEAR(law.kv[0], 30.0, rounding);
}

TEST(ControlCheck, FindsADelayThatIsNotDeclared) {
    idim::pd_cascade law;
    law.rate = 100.0;
    law.drive_gain = one(2.0);
    law.kp = one(3.0);
    law.kv = one(5.0);
    idim::log recorded;
    const Eigen::Index samples = 1000;
    recorded.t = Eigen::VectorXd::LinSpaced(samples, 0.0, 9.99);
    recorded.qr = (3.0 * recorded.t).array().sin().matrix() + (11.0 * recorded.t).array().sin().matrix();
    recorded.q = 0.9 * recorded.qr;
    recorded.qd = (3.0 * recorded.t).array().cos().matrix();
    recorded.v = Eigen::MatrixXd::Zero(samples, 1);
    for (Eigen::Index k = 3; k < samples; ++k) {
        const Eigen::Index then = k - 3;
        recorded.v(k, 0) = 15.0 * (recorded.qr(then, 0) - recorded.q(then, 0)) - 5.0 * recorded.qd(then, 0);
    }
    const auto check = idim::check_control(law, recorded).front();
    EXPECT_EQ(check.best_delay, 3);
    EXPECT_LT(check.best_rms, 1e-12);  // rounding
    EXPECT_GT(check.share, 0.05);      // a delay of 30 ms at 3 rad/s
    law.delay = 3;
    EXPECT_LT(idim::check_control(law, recorded).front().rms, 1e-12);
}

}  // namespace
