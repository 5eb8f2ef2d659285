// The simulated plant against closed forms of one and two masses on a line.
#include "undeclared/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace idim::undeclared {

namespace {

constexpr double time_step = 1e-4;  // [s]
const Eigen::VectorXd no_heat = Eigen::Vector2d(20.0, 20.0);

/// Two prismatic joints at right angles without gravity: 5 kg on the first, 2 kg of them on the second.
arm two_slides() {
    sampler random("slides", 1);
    arm robot = random_arm("gantry", random);
    robot.gravity.setZero();
    robot.links[0].mass = 3.0;
    robot.links[1].mass = 2.0;
    for (drive& one : robot.drives) {
        one.rotor_inertia = 1.0;
        one.viscous = one.coulomb = one.offset = 0.0;
    }
    return robot;
}

missing_effect effect(const std::string& form, std::map<std::string, double> linear,
                      std::map<std::string, double> shape = {}) {
    return {form, form, 1, -1, std::move(linear), std::move(shape)};
}

plant with(const arm& robot, const std::vector<missing_effect>& effects) {
    return {robot, changes_of(effects, robot), time_step, Eigen::VectorXd::Zero(2)};
}

void push(plant& machine, double force, double seconds) {
    for (int k = 0; k < std::lround(seconds / time_step); ++k) {
        machine.advance(Eigen::Vector2d(0.0, force), no_heat);
    }
}

/// Mean period of what joint 2 does beside its mean motion [s].
double period_of(plant& machine, double seconds) {
    const double start = machine.q()[1];
    std::vector<double> q;
    for (int k = 0; k < std::lround(seconds / time_step); ++k) {
        q.push_back(machine.q()[1]);
        push(machine, 0.0, time_step);
    }
    const double slope = (machine.q()[1] - start) / static_cast<double>(q.size());
    double first = 0.0, last = 0.0;
    int crossings = -1;
    for (std::size_t k = 2; k < q.size(); ++k) {
        const double before = q[k - 1] - q[k - 2] - slope, after = q[k] - q[k - 1] - slope;
        if (before < 0.0 && after >= 0.0) {
            last = static_cast<double>(k) * time_step;
            first = crossings < 0 ? last : first;
            ++crossings;
        }
    }
    return (last - first) / crossings;
}

TEST(UndeclaredPlant, JointAtRestSticksUntilTheForceExceedsFriction) {
    arm robot = two_slides();
    robot.drives[1].coulomb = 10.0;
    plant machine = with(robot, {});
    push(machine, 9.99, 1.0);
    EXPECT_NEAR(machine.q()[1], 0.0, 1e-12);  // sums of rounding
    push(machine, 13.0, 1.0);
    EXPECT_NEAR(machine.q()[1], 0.5 * (13.0 - 10.0) / 3.0, 1e-4);  // one part in as many as there are steps
}

TEST(UndeclaredPlant, StribeckFrictionHoldsBeyondCoulomb) {
    arm robot = two_slides();
    robot.drives[1].coulomb = 10.0;
    plant machine = with(robot, {effect("stribeck_friction", {{"Fs", 4.0}}, {{"vs", 0.05}})});
    push(machine, 13.9, 1.0);
    EXPECT_NEAR(machine.q()[1], 0.0, 1e-12);
    push(machine, 14.5, 0.1);
    EXPECT_GT(machine.q()[1], 0.5 * 0.5 / 3.0 * 0.01);  // faster than with all of it
}

TEST(UndeclaredPlant, SoftTransmissionOscillatesAtTheFrequencyOfTwoMasses) {
    plant machine = with(two_slides(), {effect("joint_elasticity", {{"compliance", 1e-3}}, {{"damping_ratio", 0.0}})});
    push(machine, 50.0, 0.02);
    const double expected = 2.0 * std::numbers::pi / std::sqrt(1000.0 * (1.0 / 1.0 + 1.0 / 2.0));
    EXPECT_NEAR(period_of(machine, 3.0), expected, 1e-3 * expected);  // mean motion is over whole periods but one
}

TEST(UndeclaredPlant, RotorIsFreeWithinThePlayAndCarriesTheLinkBeyond) {
    plant machine = with(two_slides(), {effect("backlash", {{"gap", 0.2}})});
    const double within = std::sqrt(2.0 * 0.08 / 6.0);  // time to 0.08 m of the 0.1 m to the flank, 1 kg under 6 N
    push(machine, 6.0, within);
    EXPECT_NEAR(machine.q()[1], 0.08, 1e-4);
    push(machine, 6.0, 3.0);
    const double velocity = machine.qd()[1];
    push(machine, 6.0, 3.0);
    EXPECT_NEAR((machine.qd()[1] - velocity) / 3.0, 6.0 / 3.0, 0.02);  // bounces have died down to a hundredth
}

TEST(UndeclaredPlant, BristleIsASpringWhileItBendsLittle) {
    arm robot = two_slides();
    robot.drives[1].coulomb = 20.0;
    plant machine = with(robot, {effect("presliding_hysteresis", {{"stretch", 0.02}})});
    push(machine, 0.1, 0.002);
    const double expected = 2.0 * std::numbers::pi / std::sqrt(20.0 / 0.02 / 3.0);
    EXPECT_NEAR(period_of(machine, 3.0), expected, 2e-3 * expected);
}

TEST(UndeclaredPlant, BristleSlidesAtCoulombFriction) {
    arm robot = two_slides();
    robot.drives[1].coulomb = 20.0;
    plant machine = with(robot, {effect("presliding_hysteresis", {{"stretch", 0.01}})});
    push(machine, 26.0, 1.0);
    const double velocity = machine.qd()[1];
    push(machine, 26.0, 1.0);
    EXPECT_NEAR(machine.qd()[1] - velocity, 6.0 / 3.0, 1e-6);
}

TEST(UndeclaredPlant, DeclaredTorqueIsTheDrivesOwnWhereNothingIsMissing) {
    arm robot = two_slides();
    robot.gravity = {0.0, 0.0, -9.81};
    robot.drives[0] = {1.0, 4.0, 3.0, 2.0, 1.0, 1.0};
    plant machine = with(robot, {});
    for (int k = 0; k < 5000; ++k) {
        const Eigen::Vector2d force(50.0 + 30.0 * std::sin(0.01 * k), std::cos(0.02 * k));
        machine.advance(force, no_heat);
        ASSERT_NEAR(machine.declared_torque()[0], force[0], 1e-9);
        ASSERT_NEAR(machine.declared_torque()[1], force[1], 1e-9);
    }
}

}  // namespace

}  // namespace idim::undeclared
