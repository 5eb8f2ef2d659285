// The regressor printed in A. Janot, P.-O. Vandanjon, M. Gautier, "Refined Instrumental Variable method for non-linear
// dynamic identification of robots", 2010, equations 52 and 53.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

constexpr double L = 0.5;

/// [53], columns ZZ1R Fv1 Fc1 ZZ2R LMX2 LMY2 Fv2 Fc2.
Eigen::MatrixXd printed_regressor(const joint_state& s) {
    const double c = std::cos(s.q[1]);
    const double z = std::sin(s.q[1]);
    const double qd1 = s.qd[0];
    const double qd2 = s.qd[1];
    const double qdd1 = s.qdd[0];
    const double qdd2 = s.qdd[1];
    Eigen::MatrixXd W(2, 8);
    W.row(0) << qdd1, qd1, std::copysign(1.0, qd1), qdd1 + qdd2, (2 * qdd1 + qdd2) * c - qd2 * (2 * qd1 + qd2) * z,
        -(2 * qdd1 + qdd2) * z - qd2 * (2 * qd1 + qd2) * c, 0.0, 0.0;
    W.row(1) << 0.0, 0.0, 0.0, qdd1 + qdd2, qdd1 * c + qd1 * qd1 * z, qd1 * qd1 * c - qdd1 * z, qd2,
        std::copysign(1.0, qd2);
    return W;
}

}  // namespace

TEST(ScaraRegressor, IsThePrintedOne) {
    const test_model scara(robot_file("scara"));
    const std::vector<std::string> names = {"ZZ1R", "Fv1", "Fc1", "ZZ2R", "MX2", "MY2", "Fv2", "Fc2"};
    ASSERT_EQ(scara.parameter_names(), names);
    std::mt19937_64 random(53);
    for (int k = 0; k < 200; ++k) {
        const joint_state s = random_state(2, random);
        Eigen::MatrixXd W = scara.regressor(s);
        W.middleCols(4, 2) /= L;  // the paper's parameters are L MX2 and L MY2
        // Elements up to 25 from about ten operations.
        EXPECT_LE((W - printed_regressor(s)).cwiseAbs().maxCoeff(), 1e-13) << "state " << k;
    }
}

TEST(ScaraRegressor, ParametersRegroupAsPrinted) {
    const generator::base_report base = generator::find_base(robot_file("scara"), templates_folder);
    ASSERT_EQ(base.parameters.size(), 8u);
    EXPECT_EQ(base.parameters[0].regroups, "ZZ1 + Ia1 + L^2*M2");  // [52]
    EXPECT_EQ(base.parameters[3].regroups, "ZZ2 + Ia2_1");         // ZZ2 + Ia2: the rotor of the direct drive
}

TEST(ScaraRegressor, LargestInertiasAreThoseOfThePaper) {
    const test_model scara(robot_file("scara"));
    const Eigen::VectorXd chi = (Eigen::VectorXd(8) << 3.44, 0.03, 0.82, 0.062, 0.242, 0.0, 0.013, 0.137).finished();
    const Eigen::MatrixXd M = scara.mass_matrix(Eigen::Vector2d(0.3, 0.0), chi);
    // J_1 = ZZ1R + ZZ2R + 2 LMX2, J_2 = ZZ2R (METHODS.md, published figures)
    EXPECT_NEAR(M(0, 0), 3.44 + 0.062 + 2 * 0.121, 1e-14);
    EXPECT_NEAR(M(1, 1), 0.062, 1e-15);
}

}  // namespace idim::test
