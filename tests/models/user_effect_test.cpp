// Effects that a user writes beside the robot description: the code then has their torque, without a line of C++ by
// hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "idim/input_error.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

const char* const user_arm =
    "name: arm\n"
    "constants: {L: 0.4}\n"
    "joints:\n"
    "  - {name: j1, theta: q}\n"
    "  - {name: j2, alpha: pi/2, theta: q}\n"
    "  - {name: j3, d: L, theta: q + pi/6}\n"
    "effects:\n"
    "  - viscous_friction\n";

double sign_without_zero(double x) {
    return x > 0.0 ? 1.0 : -1.0;
}

/// The arm with one effect more.
class user_robot {
  public:
    user_robot(const std::string& effect, const std::string& description, const std::string& use)
        : robot_file_(write(effect, description, use)), model(robot_file_) {}

    Eigen::Index column(const std::string& name) const {
        const std::vector<std::string> names = model.parameter_names();
        const auto found = std::find(names.begin(), names.end(), name);
        EXPECT_NE(found, names.end()) << name;
        return found - names.begin();
    }

  private:
    std::string write(const std::string& effect, const std::string& description, const std::string& use) const {
        folder_.write(effect + ".yaml", description);
        return folder_.write("arm.yaml", user_arm + std::string("  - ") + use + "\n");
    }

    temporary_folder folder_;
    std::string robot_file_;

  public:
    test_model model;
};

/// Column of a parameter by the closed form `torque(state, t, temp)` at all joints, and consistency of all models.
template <class F>
void expect_effect(const user_robot& robot, const std::string& parameter, const F& torque) {
    std::mt19937_64 random(13);
    const Eigen::Index column = robot.column(parameter);
    const test_model& model = robot.model;
    // Positive definite whatever the sign of the couplings: link inertias are those of plausible size, the rest is
    // small.
    value_table standard = {{"ZZ1", 3.0}, {"XX2", 1.0}, {"YY2", 1.0}, {"ZZ2", 2.0}, {"XX3", 0.4}, {"YY3", 0.5},
                            {"ZZ3", 0.5}, {"MX3", 0.3}, {"M3", 1.0},  {"Fv1", 1.0}, {"Fv2", 2.0}, {"Fv3", 3.0}};
    for (const std::string& name : model.standard_names()) {
        standard.try_emplace(name, name.rfind(parameter.substr(0, 2), 0) == 0 ? 0.05 : 0.0);
    }
    const Eigen::VectorXd chi = model.regroup(standard);
    for (int k = 0; k < 20; ++k) {
        const joint_state s = random_state(3, random);
        const double t = 0.37 * k;
        const Eigen::VectorXd temp = Eigen::Vector3d(20.0 + k, 30.0 - k, 40.0);
        const Eigen::MatrixXd W = model.regressor(s, t, temp);
        const Eigen::VectorXd expected = torque(s, t, temp);
        EXPECT_LE((W.col(column) - expected).cwiseAbs().maxCoeff(),
                  1e-13 * std::max(1.0, expected.cwiseAbs().maxCoeff()));
        const Eigen::VectorXd tau = model.inverse_dynamics(s, chi, t, temp);
        EXPECT_LE(deviation(W * chi, tau), 1e-12);
        int pivot = -1;
        EXPECT_LE(deviation(model.forward_dynamics(s, tau, chi, pivot, t, temp), s.qdd), 1e-11);
        EXPECT_EQ(pivot, 0);
        const Eigen::VectorXd inertial = model.mass_matrix(s.q, chi) * s.qdd;
        EXPECT_LE(deviation(model.bias(s, chi, t, temp) + inertial, tau), 1e-12);
    }
}

}  // namespace

TEST(UserEffect, StribeckFrictionWithItsShapeFixed) {
    const user_robot robot("my_stribeck",
                           "effect: my_stribeck\nper: joint\ntorque: Fs*exp(-(qd/vs)^2)*sign(qd)\n"
                           "linear: {Fs: {unit: N*m, min: 0}}\nshape: {vs: {unit: rad/s, range: [0.001, 1]}}\n",
                           "{effect: my_stribeck, joints: [j2], shape: {vs: 0.3}}");
    expect_effect(robot, "Fs2", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(0.0, std::exp(-std::pow(s.qd[1] / 0.3, 2)) * sign_without_zero(s.qd[1]), 0.0);
    });
}

TEST(UserEffect, CouplingFrictionOfOneJointByAnother) {
    const user_robot robot("my_coupling",
                           "effect: my_coupling\nper: pair\ntorque: Gv*qd_from + Gc*sign(qd_from)\n"
                           "linear: {Gv: {unit: N*m*s/rad}, Gc: {unit: N*m}}\n",
                           "{effect: my_coupling, joints: [j3], from: [j2]}");
    expect_effect(robot, "Gv3_2", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(0.0, 0.0, s.qd[1]);
    });
    expect_effect(robot, "Gc3_2", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(0.0, 0.0, sign_without_zero(s.qd[1]));
    });
}

TEST(UserEffect, CouplingThatActsOnBothJointsEntersTheMassMatrixSymmetrically) {
    const user_robot robot(
        "my_wrist",
        "effect: my_wrist\nper: pair\nacts_on: both\ntorque: Ja*qdd_from + Jv*qd_from + Jc*sign(qd + qd_from)\n"
        "linear: {Ja: {unit: kg*m^2}, Jv: {unit: N*m*s/rad}, Jc: {unit: N*m}}\n",
        "{effect: my_wrist, joints: [j3], from: [j1]}");
    expect_effect(robot, "Ja3_1", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(s.qdd[2], 0.0, s.qdd[0]);
    });
    expect_effect(robot, "Jc3_1", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(sign_without_zero(s.qd[0] + s.qd[2]), 0.0, sign_without_zero(s.qd[0] + s.qd[2]));
    });
    const Eigen::VectorXd chi = Eigen::VectorXd::Unit(robot.model.n_base(), robot.column("Ja3_1"));
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    expected(0, 2) = expected(2, 0) = 1.0;
    EXPECT_EQ(robot.model.mass_matrix(Eigen::Vector3d(0.1, 0.2, 0.3), chi), expected);
}

TEST(UserEffect, AsymmetricViscousFriction) {
    const user_robot robot("my_asymmetry",
                           "effect: my_asymmetry\nper: joint\ntorque: Ga*abs(qd)\nlinear: {Ga: {unit: N*m*s/rad}}\n",
                           "my_asymmetry");
    for (int j = 0; j < 3; ++j) {
        expect_effect(robot, "Ga" + std::to_string(j + 1), [j](const joint_state& s, double, const Eigen::VectorXd&) {
            return Eigen::VectorXd(std::abs(s.qd[j]) * Eigen::Vector3d::Unit(j));
        });
    }
}

TEST(UserEffect, FrictionThatWarmsUpInTime) {
    const user_robot robot("my_warm_up",
                           "effect: my_warm_up\nper: joint\ntorque: Gw*qd*exp(-t/tc)\nlinear: {Gw: {unit: N*m*s/rad}}\n"
                           "shape: {tc: {unit: s, range: [1, 1000]}}\n",
                           "{effect: my_warm_up, joints: [j1], shape: {tc: 12.5}}");
    EXPECT_EQ(robot.model.interface().needs_time, 1);
    EXPECT_EQ(robot.model.interface().needs_temperature, 0);
    expect_effect(robot, "Gw1", [](const joint_state& s, double t, const Eigen::VectorXd&) {
        return Eigen::Vector3d(s.qd[0] * std::exp(-t / 12.5), 0.0, 0.0);
    });
}

TEST(UserEffect, FrictionOfMeasuredTemperature) {
    const user_robot robot(
        "my_thermal", "effect: my_thermal\nper: joint\ntorque: Gt*qd*(temp - 25)\nlinear: {Gt: {unit: N*m*s/rad}}\n",
        "{effect: my_thermal, joints: [j2]}");
    EXPECT_EQ(robot.model.interface().needs_time, 0);
    EXPECT_EQ(robot.model.interface().needs_temperature, 1);
    expect_effect(robot, "Gt2", [](const joint_state& s, double, const Eigen::VectorXd& temp) {
        return Eigen::Vector3d(0.0, s.qd[1] * (temp[1] - 25.0), 0.0);
    });
}

TEST(UserEffect, RippleWithPiInItsExpression) {
    const user_robot robot(
        "my_ripple",
        "effect: my_ripple\nper: joint\ntorque: Gs*sin(2*pi*q/step) + Gk*cos(2*pi*q/step)\n"
        "linear: {Gs: {unit: N*m}, Gk: {unit: N*m}}\nshape: {step: {unit: rad, range: [0.001, 10]}}\n",
        "{effect: my_ripple, joints: [j3], shape: {step: 0.7}}");
    expect_effect(robot, "Gs3", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(0.0, 0.0, std::sin(2.0 * std::numbers::pi * s.q[2] / 0.7));
    });
}

TEST(UserEffect, TorqueThatIsNotLinearInItsCoefficientsIsRefused) {
    const temporary_folder folder;
    for (const char* torque : {"Ga*Gb*qd", "Ga^2*qd + Gb", "sin(Ga)*qd + Gb", "Ga*qd + Gb + 1", "Ga*qdd^2 + Gb"}) {
        folder.write("bad.yaml", std::string("effect: bad\nper: joint\ntorque: ") + torque +
                                     "\nlinear: {Ga: {unit: N*m}, Gb: {unit: N*m}}\n");
        const std::string robot = folder.write("arm.yaml", user_arm + std::string("  - bad\n"));
        EXPECT_THROW(generator::find_base(robot, templates_folder), input_error) << torque;
    }
}

TEST(UserEffect, AFileBesideTheRobotComesBeforeTheCatalogue) {
    const user_robot robot("coulomb_friction",
                           "effect: coulomb_friction\nper: joint\ntorque: Fc*tanh(qd/0.1)\nlinear: {Fc: {unit: N*m}}\n",
                           "coulomb_friction");
    expect_effect(robot, "Fc1", [](const joint_state& s, double, const Eigen::VectorXd&) {
        return Eigen::Vector3d(std::tanh(s.qd[0] / 0.1), 0.0, 0.0);
    });
}

}  // namespace idim::test
