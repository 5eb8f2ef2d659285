#include "idim/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "idim/input_error.hpp"
#include "support/one_joint.hpp"

namespace {

using idim::test::one;

/// One mass on a rail with viscous and Coulomb friction: chi = (M, Fv, Fc).
void mass_matrix(const double*, const double* chi, double* M) {
    M[0] = chi[0];
}

double rail_friction(double speed, const double* chi) {
    return chi[1] * speed + chi[2] * (static_cast<double>(speed > 0) - static_cast<double>(speed < 0));
}

void rail_bias(const double*, const double* qd, double, const double*, const double* chi, double* N) {
    N[0] = rail_friction(qd[0], chi);
}

int forward_dynamics(const double*, const double* qd, const double* tau, double, const double*, const double* chi,
                     double* qdd) {
    qdd[0] = (tau[0] - rail_friction(qd[0], chi)) / chi[0];
    return chi[0] > 0.0 ? 0 : 1;
}

const char* const rail_joint_names[] = {"rail"};
const int rail_joint_is_prismatic[] = {1};

idim_model_interface rail() {
    idim_model_interface model{};
    model.abi = IDIM_MODEL_ABI;
    model.robot = "rail";
    model.dof = 1;
    model.n_base = 3;
    model.joint_names = rail_joint_names;
    model.joint_is_prismatic = rail_joint_is_prismatic;
    model.mass_matrix = mass_matrix;
    model.bias = rail_bias;
    model.forward_dynamics = forward_dynamics;
    return model;
}

idim::log step_reference(double height, double seconds) {
    idim::log reference;
    reference.t = Eigen::VectorXd::LinSpaced(3, 0.0, 2.0);
    reference.t << 0.0, 1e-9, seconds;
    reference.qr.resize(3, 1);
    reference.qr << 0.0, height, height;
    return reference;
}

idim::measurement_noise no_noise() {
    return {one(0.0), one(0.0), 1};
}

TEST(Simulation, StepResponseHasTheDeclaredBandwidthAndDamping) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 0.0, 0.0).finished();
    const double wn = 4.0;
    const double zeta = 0.7;
    const auto law = idim::tune_pd_cascade(5000.0, one(wn), one(zeta), idim::largest_inertia(model, chi), one(35.0));
    const auto motion = idim::simulate(model, chi, law, step_reference(0.1, 3.0), no_noise());
    const double wd = wn * std::sqrt(1.0 - zeta * zeta);
    for (Eigen::Index k = 0; k < motion.truth.samples(); k += 500) {
        const double t = motion.truth.t[k];
        // Second-order step response [IV 42].
        const double expected =
            0.1 * (1.0 - std::exp(-zeta * wn * t) *
                             (std::cos(wd * t) + zeta / std::sqrt(1.0 - zeta * zeta) * std::sin(wd * t)));
        // The sampled loop lags by about a period of 0.2 ms at speeds up to 0.2 m/s.
        EXPECT_NEAR(motion.truth.q(k, 0), expected, 1e-4) << t;
    }
}

TEST(Simulation, RungeKuttaConvergesWithItsOrder) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 1.0, 50.0, 0.0).finished();  // time constant of 20 ms
    const auto law = idim::tune_pd_cascade(10.0, one(2.0), one(1.0), one(1.0), one(1.0));
    const auto end = [&](int substeps) {
        const auto motion = idim::simulate(model, chi, law, step_reference(1.0, 1.0), no_noise(), substeps);
        return motion.truth.q(motion.truth.samples() - 1, 0);
    };
    const double exact = end(640);
    const double ratio = std::abs(end(10) - exact) / std::abs(end(20) - exact);
    EXPECT_GT(ratio, 11.0);  // 16 for the leading term of order four, higher terms at a step of half a time constant
    EXPECT_LT(ratio, 26.0);
}

TEST(Simulation, TheLoggedTorqueIsNeitherEarlyNorLate) {
    // A ramp of the command is held in steps; the mean of the steps before and after a sample is the ramp half a period
    // back from the command, which is where the motion answers to.
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 2.0, 0.0, 0.0).finished();
    const auto law = idim::tune_pd_cascade(100.0, one(3.0), one(1.0), one(2.0), one(1.0));
    const auto motion = idim::simulate(model, chi, law, step_reference(0.5, 2.0), no_noise());
    double with_mean = 0.0;
    double with_command = 0.0;
    for (Eigen::Index k = 5; k + 1 < motion.truth.samples(); ++k) {
        const double acceleration = (motion.truth.qd(k + 1, 0) - motion.truth.qd(k - 1, 0)) / 0.02;
        with_mean += std::abs(motion.measured.tau(k, 0) - 2.0 * acceleration);
        with_command += std::abs(motion.truth.tau(k, 0) - 2.0 * acceleration);
    }
    EXPECT_LT(with_mean, 1e-6 * with_command);
}

TEST(Simulation, TheTorqueIsRecordedAsLateAsItsDriveIs) {
    idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 2.0, 1.0, 0.0).finished();
    const auto law = idim::tune_pd_cascade(1000.0, one(3.0), one(1.0), one(2.0), one(1.0));
    const auto motion = idim::simulate(model, chi, law, step_reference(0.5, 2.0), no_noise());
    const double late[] = {0.0125};  // twelve samples and a half
    model.torque_delay = late;
    const auto delayed = idim::simulate(model, chi, law, step_reference(0.5, 2.0), no_noise());
    EXPECT_EQ(delayed.measured.q, motion.measured.q);
    const Eigen::MatrixXd& tau = motion.measured.tau;
    for (Eigen::Index k = 13; k < tau.rows(); ++k) {
        EXPECT_NEAR(delayed.measured.tau(k, 0), 0.5 * (tau(k - 12, 0) + tau(k - 13, 0)), 1e-12 * tau.norm()) << k;
    }
}

TEST(Simulation, NoiseHasTheGivenDeviationAndTheSameSeedGivesTheSameLog) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 1.0, 0.5).finished();
    const auto law = idim::tune_pd_cascade(1000.0, one(4.0), one(1.0), one(3.0), one(1.0));
    const idim::measurement_noise noise{one(1e-4), one(0.2), 7};
    const auto first = idim::simulate(model, chi, law, step_reference(0.2, 10.0), noise);
    const auto second = idim::simulate(model, chi, law, step_reference(0.2, 10.0), noise);
    EXPECT_EQ(first.measured.q, second.measured.q);
    EXPECT_EQ(first.measured.tau, second.measured.tau);
    const Eigen::VectorXd error = first.measured.q - first.truth.q;
    const double deviation = std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
    EXPECT_NEAR(deviation, 1e-4, 3e-6);  // 10 001 draws: 0.7 % standard error, four of them
}

TEST(Simulation, SaturationLimitsTheTorque) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 1.0, 0.5).finished();
    auto law = idim::tune_pd_cascade(1000.0, one(40.0), one(1.0), one(3.0), one(2.0));
    law.saturation = one(5.0);
    const auto motion = idim::simulate(model, chi, law, step_reference(1.0, 1.0), no_noise());
    EXPECT_EQ(motion.truth.tau.cwiseAbs().maxCoeff(), 10.0);
}

TEST(Simulation, FailuresNameTimeAndJoint) {
    const idim_model_interface model = rail();
    const auto law = idim::tune_pd_cascade(100.0, one(4.0), one(1.0), one(3.0), one(1.0));
    const auto message = [&](const Eigen::VectorXd& chi, const idim::pd_cascade& with) -> std::string {
        try {
            idim::simulate(model, chi, with, step_reference(1.0, 100.0), no_noise());
        } catch (const idim::data_error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message((Eigen::VectorXd(3) << -1.0, 0.0, 0.0).finished(), law),
              "simulation at t = 0.0000 s: the inertia matrix is not positive definite at joint rail; the parameters "
              "are not physical");
    const auto wild = idim::tune_pd_cascade(10.0, one(500.0), one(1.0), one(3.0), one(1.0));
    EXPECT_NE(message((Eigen::VectorXd(3) << 3.0, 0.0, 0.0).finished(), wild).find("diverges at t = "),
              std::string::npos);
}

idim::simulated_motion slide(const Eigen::VectorXd& chi, idim::integration_options integration, double rate) {
    static const idim_model_interface model = rail();
    idim::pd_cascade coasting;  // no command at all
    coasting.rate = rate;
    coasting.drive_gain = coasting.kp = coasting.kv = one(0.0);
    idim::log reference = step_reference(0.0, 2.0);
    idim::simulated_loop_setup setup{model, chi, coasting, reference};
    setup.integration = integration;
    setup.start_velocity = one(1.0);
    return idim::simulate(setup);
}

TEST(Simulation, ASlidingMassStopsWhereFrictionStopsItAndStays) {
    // v^2 M / (2 Fc) with v = 1 m/s, M = 3 kg, Fc = 2.2 N; the stop lies between two samples and two steps.
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 0.0, 2.2).finished();
    for (const auto method : {idim::integrator::rk4, idim::integrator::dopri5}) {
        idim::integration_options integration;
        integration.method = method;
        const auto motion = slide(chi, integration, 70.0);
        const Eigen::Index last = motion.truth.samples() - 1;
        // Constant deceleration: exact for both methods but for rounding and the 1e-12 m/s of the located event.
        EXPECT_NEAR(motion.truth.q(last, 0), 3.0 / 4.4, 1e-10);
        EXPECT_EQ(motion.truth.qd(last, 0), 0.0);
        EXPECT_EQ(motion.truth.qdd(last, 0), 0.0);
    }
}

TEST(Simulation, ViscousAndDryFrictionStopAMassInClosedForm) {
    // M v' = -Fv v - Fc: x = M/Fv (v0 - Fc/Fv ln(1 + Fv v0 / Fc)).
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 2.0, 1.5, 2.0).finished();
    const double expected = 2.0 / 1.5 * (1.0 - 2.0 / 1.5 * std::log(1.0 + 1.5 / 2.0));
    const auto motion = slide(chi, {}, 1000.0);
    EXPECT_NEAR(motion.truth.q(motion.truth.samples() - 1, 0), expected, 1e-10);  // rk4 at 1 ms of a 1.3 s constant
    idim::integration_options regularised;
    regularised.friction = idim::friction_handling::regularised;
    regularised.band = 1e-4;
    // It still creeps through the band, M band / Fc * band at most.
    EXPECT_NEAR(slide(chi, regularised, 20000.0).truth.q.bottomRows(1)(0, 0), expected, 1e-7);
}

TEST(Simulation, AJointHoldsAgainstLessThanItsFrictionAndBreaksAwayBeyondIt) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 2.0, 0.0, 5.0).finished();
    idim::pd_cascade law;
    law.rate = 100.0;
    law.drive_gain = law.kp = one(1.0);
    law.kv = one(1.0);
    idim::log ramp = step_reference(0.0, 10.0);
    ramp.t << 0.0, 5.0, 10.0;
    ramp.qr << 0.0, 5.0, 10.0;  // the command is the time while nothing moves: breaks away after 5 s
    const auto motion = idim::simulate(model, chi, law, ramp, {});
    EXPECT_EQ(motion.truth.q(500, 0), 0.0);
    EXPECT_EQ(motion.truth.q(501, 0), 0.0);  // the command of 5.01 N is only given at this sample
    EXPECT_GT(motion.truth.q(502, 0), 0.0);
}

/// Two coupled joints, M = [[3, 1], [1, 2]] and a load of 4 at the second from t = 1 on; the first has friction of 50
/// and its drive records 1.25 times the torque.
int loaded_pair(const double*, const double* qd, const double* tau, double t, const double*, const double*,
                double* qdd) {
    const double first = tau[0] / 1.25 - 50.0 * (static_cast<double>(qd[0] > 0) - static_cast<double>(qd[0] < 0));
    const double m22 = t < 1.0 ? 2.0 : 6.0;
    const double det = 3.0 * m22 - 1.0;
    qdd[0] = (m22 * first - tau[1]) / det;
    qdd[1] = (3.0 * tau[1] - first) / det;
    return 0;
}

TEST(Simulation, AJointAtRestHoldsWhileALoadComesOnAtAnother) {
    // With the first joint held the second is a mass of 2, then of 6, whatever the drive of the first records.
    idim_model_interface model = rail();
    static const char* const names[] = {"held", "free"};
    model.dof = 2;
    model.joint_names = names;
    model.mass_matrix = nullptr;
    model.forward_dynamics = loaded_pair;
    model.bias = [](const double*, const double* qd, double, const double*, const double*, double* N) {
        N[0] = 62.5 * (static_cast<double>(qd[0] > 0) - static_cast<double>(qd[0] < 0));
        N[1] = 0.0;
    };
    idim::pd_cascade law;
    law.rate = 100.0;
    law.drive_gain = law.kp = Eigen::Vector2d(1.0, 1.0);
    law.kv = Eigen::Vector2d(0.0, 1.0);
    idim::log reference;
    reference.t = Eigen::Vector2d(0.0, 2.0);
    reference.qr = (Eigen::Matrix2d() << 0.0, 0.3, 0.0, 0.3).finished();
    const Eigen::VectorXd chi = Eigen::VectorXd::Zero(3);
    const auto motion = idim::simulate({model, chi, law, reference});
    ASSERT_FALSE(motion.failure.has_value());
    EXPECT_EQ(motion.truth.q.col(0), Eigen::VectorXd::Zero(motion.truth.samples()));
    for (const Eigen::Index k : {0, 50, 99, 100, 150}) {
        const double mass = motion.truth.t[k] < 1.0 ? 2.0 : 6.0;
        EXPECT_NEAR(motion.truth.qdd(k, 1), motion.truth.tau(k, 1) / mass, 1e-12) << k;
    }
}

TEST(Simulation, ColouredNoiseKeepsItsDeviationAndItsCorrelationTime) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 0.0, 0.0).finished();
    const auto law = idim::tune_pd_cascade(1000.0, one(4.0), one(1.0), one(3.0), one(1.0));
    idim::measurement_noise noise{one(0.0), one(0.2), 3};
    noise.torque_correlation = 0.005;
    const idim::log reference = step_reference(0.0, 100.0);
    const auto motion = idim::simulate(model, chi, law, reference, noise);
    const Eigen::VectorXd error = motion.measured.tau.col(0);  // nothing moves: all of it is noise
    const Eigen::Index n = error.size();
    const double variance = error.squaredNorm() / static_cast<double>(n);
    const double lagged = error.head(n - 5).dot(error.tail(n - 5)) / static_cast<double>(n - 5);
    // 1e5 samples, a tenth of them independent: 1 % standard error of the variance, four of them.
    EXPECT_NEAR(variance, 0.04, 0.0016);
    EXPECT_NEAR(lagged / variance, std::exp(-1.0), 0.04);
}

TEST(Simulation, EncodersRoundToTheirStep) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 0.0, 0.0).finished();
    const auto law = idim::tune_pd_cascade(1000.0, one(4.0), one(1.0), one(3.0), one(1.0));
    idim::measurement_noise noise;
    noise.resolution = one(0.0078125);  // 2^-7: multiples are exact
    const auto motion = idim::simulate(model, chi, law, step_reference(0.3, 3.0), noise);
    const Eigen::VectorXd steps = motion.measured.q.col(0) / 0.0078125;
    EXPECT_EQ(steps, Eigen::VectorXd(steps.array().round()));
    EXPECT_LE((motion.measured.q - motion.truth.q).cwiseAbs().maxCoeff(), 0.5 * 0.0078125);
    EXPECT_GT(steps.maxCoeff(), 30.0);
}

TEST(Simulation, AFailureKeepsTheFiniteSamplesBeforeIt) {
    const idim_model_interface model = rail();
    const Eigen::VectorXd chi = (Eigen::VectorXd(3) << 3.0, 0.0, 0.0).finished();
    const auto wild = idim::tune_pd_cascade(10.0, one(500.0), one(1.0), one(3.0), one(1.0));
    const idim::log reference = step_reference(1.0, 100.0);
    const auto motion = idim::simulate({model, chi, wild, reference});
    ASSERT_TRUE(motion.failure.has_value());
    EXPECT_EQ(motion.failure->joint, 0);
    EXPECT_GT(motion.truth.samples(), 0);
    EXPECT_LE(motion.truth.t[motion.truth.samples() - 1], motion.failure->time);
    EXPECT_TRUE(motion.truth.q.allFinite() && motion.truth.qdd.allFinite() && motion.measured.tau.allFinite());
}

}  // namespace
