// What a simulated log holds: the effect's torque is the formula of the catalogue, and nothing where nothing is
// missing.
#include "undeclared/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>

#include "undeclared/bench_case.hpp"

namespace idim::undeclared {

namespace {

/// An upright arm of two links, or two slides, on a random motion of 6 s without noise.
struct stage {
    explicit stage(const std::string& kind)
        : random(kind, 3), robot(random_arm(kind, random)), reference(reference_of()) {
        size_drives(robot, scales_along(robot, reference), true, random);
        scales = scales_along(robot, reference);
        settings.position.size = Eigen::VectorXd::Zero(robot.dof());
        settings.torque.size = Eigen::VectorXd::Zero(robot.dof());
        settings.regularisation = 1e-4;
    }
    motion reference_of() { return {robot, 6.0, 0.0, 0.6, random}; }
    recording with(const missing_effect& effect) {
        return record(robot, changes_of({effect}, robot), reference, scales, settings, random);
    }

    sampler random;
    arm robot;
    motion reference;
    joint_scales scales;
    recording_settings settings;
};

double sign(double v) {
    return v > 0.0 ? 1.0 : -1.0;
}

using formula = std::function<double(double t, double q, double qd)>;

/// Largest distance of the effect's torque at a joint from a formula where the joint moves, of the largest torque.
double distance(const recording& made, int joint, const formula& torque) {
    constexpr double rate = 1000.0, slow = 0.05;
    double worst = 0.0;
    for (Eigen::Index k = 1000; k + 1000 < made.t.size(); ++k) {
        const double qd = 0.5 * rate * (made.clean_q(k + 1, joint) - made.clean_q(k - 1, joint));
        if (std::abs(qd) > slow) {
            worst = std::max(worst, std::abs(made.effect(k, joint) - torque(made.t[k], made.clean_q(k, joint), qd)));
        }
    }
    return worst / made.effect.col(joint).cwiseAbs().maxCoeff();
}

struct known_effect {
    missing_effect effect;
    formula torque;
};

void PrintTo(const known_effect& known, std::ostream* out) {
    *out << known.effect.name;
}

class EffectTorque : public testing::TestWithParam<known_effect> {};

TEST_P(EffectTorque, IsTheFormulaOfTheCatalogue) {
    stage upright("vertical");
    // The mean over the sample against the value in its middle, and velocities half a step off: a few thousandths.
    EXPECT_LT(distance(upright.with(GetParam().effect), 1, GetParam().torque), 5e-3);
}

known_effect known(const std::string& form, std::map<std::string, double> linear, std::map<std::string, double> shape,
                   formula torque) {
    return {{form, form, 1, 0, std::move(linear), std::move(shape)}, std::move(torque)};
}

INSTANTIATE_TEST_SUITE_P(
    Undeclared, EffectTorque,
    testing::Values(
        known("torque_offset", {{"off", 0.3}}, {}, [](double, double, double) { return 0.3; }),
        known("viscous_friction", {{"Fv", 0.2}}, {}, [](double, double, double v) { return 0.2 * v; }),
        known("asymmetric_viscous_friction", {{"Fva", 0.2}}, {},
              [](double, double, double v) { return 0.2 * std::abs(v); }),
        known("coulomb_friction", {{"Fc", 0.1}}, {}, [](double, double, double v) { return 0.1 * sign(v); }),
        known("stribeck_friction", {{"Fs", 0.1}}, {{"vs", 0.5}},
              [](double, double, double v) { return 0.1 * std::exp(-v * v / 0.25) * sign(v); }),
        known("nonlinear_viscous_friction", {{"Fp", 0.1}}, {{"p", 2.0}},
              [](double, double, double v) { return 0.1 * v * v * sign(v); }),
        known("nonlinear_viscous_friction", {{"Fp", 0.1}}, {{"p", 0.5}},
              [](double, double, double v) { return 0.1 * std::sqrt(std::abs(v)) * sign(v); }),
        known("position_dependent_friction", {{"Fcc", 0.02}, {"Fcs", 0.01}}, {{"k", 3.0}},
              [](double, double q, double v) {
                  return (0.02 * std::cos(3.0 * q) + 0.01 * std::sin(3.0 * q)) * sign(v);
              }),
        known("torque_ripple", {{"Ac", 0.1}, {"As", -0.2}}, {{"k", 8.0}},
              [](double, double q, double) { return 0.1 * std::cos(8.0 * q) - 0.2 * std::sin(8.0 * q); }),
        known("spring", {{"K", 0.4}, {"K0", 0.1}}, {}, [](double, double q, double) { return 0.4 * q + 0.1; }),
        known("gravity_compensator", {{"Kc", 0.1}, {"Ks", 0.2}}, {},
              [](double, double q, double) { return 0.1 * std::cos(q) + 0.2 * std::sin(q); }),
        known("thermal_friction", {{"Fvt", 0.3}}, {{"tc", 4.0}},
              [](double time, double, double v) { return 0.3 * std::exp(-time / 4.0) * v; }),
        known("periodic_disturbance", {{"Ac", 0.1}, {"As", 0.2}}, {{"w", 9.0}},
              [](double time, double, double) { return 0.1 * std::cos(9.0 * time) + 0.2 * std::sin(9.0 * time); })));

TEST(UndeclaredRecording, LoadAddsItsWeightAndInertiaWhileItIsOn) {
    stage slides("gantry");
    missing_effect load{"payload", "payload", 1, -1, {{"M", 2.0}}, {{"t0", 2.0}, {"t1", 4.0}}};
    for (const char* name : {"x0", "x1", "x2", "I01", "I02", "I12"}) {
        load.shape[name] = 0.0;
    }
    for (const char* name : {"I00", "I11", "I22"}) {
        load.shape[name] = 0.01;
    }
    const recording made = slides.with(load);
    for (Eigen::Index k = 100; k + 100 < made.t.size(); ++k) {
        const double t = made.t[k];
        const double qdd = 1e6 * (made.clean_q(k + 1, 0) - 2.0 * made.clean_q(k, 0) + made.clean_q(k - 1, 0));
        const bool on = t >= 2.0 && t < 4.0;
        if (std::abs(t - 2.0) > 0.01 && std::abs(t - 4.0) > 0.01) {
            ASSERT_NEAR(made.effect(k, 0), on ? 2.0 * (9.81 + qdd) : 0.0, 0.05) << t;  // friction jumps within a sample
        }
    }
}

TEST(UndeclaredRecording, TiltPullsAlongTheLevelSlide) {
    stage slides("gantry");
    const double angle = 0.05;
    const recording made = slides.with({"base_tilt", "base_tilt", 0, -1, {{"tilt_x", angle}, {"tilt_y", 0.0}}, {}});
    const double M = slides.robot.links[0].mass + slides.robot.links[1].mass;
    const double pull = made.effect.col(1).mean();
    EXPECT_NEAR(made.effect.col(0).mean(), M * 9.81 * (std::cos(angle) - 1.0), 1e-6);
    EXPECT_LE(std::abs(pull), slides.robot.links[1].mass * 9.81 * std::sin(angle) + 1e-6);
}

TEST(UndeclaredRecording, LateTorqueIsTheSameTorqueLater) {
    stage upright("vertical");
    const recording made = upright.with({"torque_delay", "torque_delay", 1, -1, {{"Td", 0.007}}, {}});
    const Eigen::MatrixXd prompt = made.tau - made.effect;
    for (Eigen::Index k = 10; k < made.t.size(); ++k) {
        ASSERT_NEAR(made.tau(k, 1), prompt(k - 7, 1), 1e-9);
        ASSERT_NEAR(made.tau(k, 0), prompt(k, 0), 1e-9);
    }
}

TEST(UndeclaredRecording, WrongGainScalesTheWholeTorqueOfItsJoint) {
    stage upright("vertical");
    const recording made = upright.with({"drive_gain_error", "drive_gain_error", 0, -1, {{"gain", 0.03}}, {}});
    const Eigen::MatrixXd right = made.tau - made.effect;
    EXPECT_LT((made.tau.col(0) - 1.03 * right.col(0)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((made.tau.col(1) - right.col(1)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(UndeclaredRecording, NothingMissingLeavesNoEffect) {
    for (const char* name : {"nothing", "sticking"}) {
        const bench_case made = make_case(name, 1);
        for (const recording& log : made.identification) {
            EXPECT_LT(log.effect.cwiseAbs().maxCoeff(), 1e-9 * log.tau.cwiseAbs().maxCoeff()) << name;
        }
    }
}

}  // namespace

}  // namespace idim::undeclared
