#include "idim/torque_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace idim {

namespace {

// Two pendulums that nothing joins, m l^2 and friction known: tau_j = I_j qdd_j + K_j sin(q_j) + Fv_j qd_j.
constexpr double gain = 1.0 + 1e-6;
const char* const joints[] = {"j1", "j2"};
const int revolute[] = {0, 0};
const char* const standard[] = {"I1", "K1", "Fv1", "I2", "K2"};
const char* const with_offset[] = {"off2", "I2", "K2", "I1", "K1"};

idim_model_interface pendulums() {
    idim_model_interface model{};
    model.dof = 2;
    model.n_base = 5;
    model.n_standard = 5;
    model.joint_names = joints;
    model.joint_is_prismatic = revolute;
    model.standard_names = standard;
    model.regroup = [](const double* values, double* chi) { std::copy(values, values + 5, chi); };
    model.inverse_dynamics = [](const double* q, const double* qd, const double* qdd, double, const double*,
                                const double* chi, double* tau) {
        tau[0] = chi[0] * qdd[0] + chi[1] * std::sin(q[0]) + chi[2] * qd[0];
        tau[1] = chi[3] * qdd[1] + chi[4] * std::sin(q[1]);
    };
    return model;
}

/// The same sums the other way round.
idim_model_interface reordered() {
    idim_model_interface model = pendulums();
    model.inverse_dynamics = [](const double* q, const double* qd, const double* qdd, double, const double*,
                                const double* chi, double* tau) {
        tau[0] = chi[0] * qdd[0] + (chi[1] * std::sin(q[0]) + chi[2] * qd[0]);
        tau[1] = chi[4] * std::sin(q[1]) + chi[3] * qdd[1];
    };
    return model;
}

/// Without friction at the first joint, with an offset at the second, and its parameters in another order.
idim_model_interface offset_pendulums() {
    idim_model_interface model = pendulums();
    model.standard_names = with_offset;
    model.inverse_dynamics = [](const double* q, const double*, const double* qdd, double, const double*,
                                const double* chi, double* tau) {
        tau[0] = chi[3] * qdd[0] + chi[4] * std::sin(q[0]) + 0.0;
        tau[1] = chi[1] * qdd[1] + chi[2] * std::sin(q[1]) + chi[0];
    };
    return model;
}

std::vector<joint_range> ranges() {
    return {{-1.0, 2.0, 3.0, 10.0}, {0.5, 0.5, 0.0, 4.0}};
}

}  // namespace

TEST(TorqueComparison, OfAModelWithItselfIsTheSameToTheLastBit) {
    const torque_comparison found = compare_torques(pendulums(), pendulums(), ranges());
    EXPECT_EQ(found.verdict, torque_verdict::same);
    EXPECT_EQ(found.absolute.value, 0.0);
    EXPECT_EQ(found.relative.value, 0.0);
    EXPECT_TRUE(found.only_before.empty() && found.only_after.empty());
}

TEST(TorqueComparison, SumsInAnotherOrderAreTheSameUpToRounding) {
    const torque_comparison found = compare_torques(pendulums(), reordered(), ranges());
    EXPECT_EQ(found.verdict, torque_verdict::same_up_to_rounding);
    EXPECT_GT(found.relative.value, 0.0);
    EXPECT_LT(found.relative.value, 1e-15);  // two additions, each half a unit of the last place (1.1e-16) of a term
}

TEST(TorqueComparison, FindsAGainOfAMillionthAndSaysWhere) {
    idim_model_interface model = pendulums();
    model.inverse_dynamics = [](const double* q, const double* qd, const double* qdd, double, const double*,
                                const double* chi, double* tau) {
        tau[0] = chi[0] * qdd[0] + chi[1] * std::sin(q[0]) + chi[2] * qd[0];
        tau[1] = gain * (chi[3] * qdd[1] + chi[4] * std::sin(q[1]));
    };
    const torque_comparison found = compare_torques(pendulums(), model, ranges());
    EXPECT_EQ(found.verdict, torque_verdict::different);
    for (const torque_difference& largest : {found.absolute, found.relative}) {
        EXPECT_EQ(largest.joint, 1);
        EXPECT_EQ(largest.q[1], 0.5);
        EXPECT_EQ(largest.qd[1], 0.0);
        EXPECT_LE(std::abs(largest.qdd[1]), 4.0);
        // The reported torques are those at the reported state: the difference is 1e-6 of the first.
        EXPECT_NEAR(largest.after - largest.before, (gain - 1.0) * largest.before, 1e-15);
    }
    EXPECT_NEAR(found.absolute.value, std::abs(found.absolute.after - found.absolute.before), 0.0);
    // Largest where the torque itself is largest: the part is the millionth, but for rounding.
    EXPECT_NEAR(found.relative.value, 1e-6 / gain, 1e-15);
}

TEST(TorqueComparison, ParametersOfOneSideAreZeroAndTheJointsTheyMoveAreNamed) {
    const torque_comparison found = compare_torques(pendulums(), offset_pendulums(), ranges());
    EXPECT_EQ(found.verdict, torque_verdict::same) << found.relative.value;
    ASSERT_EQ(found.only_before.size(), 1u);
    EXPECT_EQ(found.only_before[0].name, "Fv1");
    EXPECT_EQ(found.only_before[0].joints, std::vector<int>{0});
    ASSERT_EQ(found.only_after.size(), 1u);
    EXPECT_EQ(found.only_after[0].name, "off2");
    EXPECT_EQ(found.only_after[0].joints, std::vector<int>{1});
}

TEST(TorqueComparison, AParameterWithoutEffectMovesNoJoint) {
    idim_model_interface model = offset_pendulums();
    model.inverse_dynamics = [](const double* q, const double*, const double* qdd, double, const double*,
                                const double* chi, double* tau) {
        tau[0] = chi[3] * qdd[0] + chi[4] * std::sin(q[0]);
        tau[1] = chi[1] * qdd[1] + chi[2] * std::sin(q[1]);
    };
    EXPECT_TRUE(compare_torques(pendulums(), model, ranges()).only_after[0].joints.empty());
}

TEST(TorqueComparison, ATorqueThatIsNoNumberOnOneSideIsAnInfiniteDifference) {
    idim_model_interface model = pendulums();
    model.inverse_dynamics = [](const double* q, const double*, const double*, double, const double*, const double*,
                                double* tau) {
        tau[0] = 0.0;
        tau[1] = std::log(-q[1]);  // q2 is 0.5 throughout
    };
    const torque_comparison found = compare_torques(pendulums(), model, ranges());
    EXPECT_EQ(found.verdict, torque_verdict::different);
    EXPECT_EQ(found.absolute.value, std::numeric_limits<double>::infinity());
    EXPECT_EQ(found.absolute.joint, 1);
    EXPECT_EQ(compare_torques(model, model, ranges()).verdict, torque_verdict::same);
}

TEST(TorqueComparison, StatesStayWithinTheRangesAndFillThem) {
    static double lowest, highest, fastest;
    lowest = highest = 0.5;
    fastest = 0.0;
    idim_model_interface model = pendulums();
    model.inverse_dynamics = [](const double* q, const double* qd, const double*, double t, const double* temp,
                                const double*, double* tau) {
        lowest = std::min(lowest, q[0]);
        highest = std::max(highest, q[0]);
        fastest = std::max(fastest, std::abs(qd[0]));
        tau[0] = t >= 0.0 && t <= 100.0 ? 0.0 : 1.0;
        tau[1] = temp[0] >= 0.0 && temp[1] <= 60.0 ? 0.0 : 1.0;
    };
    const torque_comparison found = compare_torques(model, model, ranges());
    EXPECT_EQ(found.absolute.before, 0.0);
    EXPECT_GE(lowest, -1.0);
    EXPECT_LE(highest, 2.0);
    EXPECT_LE(fastest, 3.0);
    // 2000 uniform draws miss the outer hundredth of a range with probability 2e-9; the seed is fixed besides.
    EXPECT_LT(lowest, -0.97);
    EXPECT_GT(highest, 1.97);
    EXPECT_GT(fastest, 2.97);
}

TEST(TorqueComparison, DifferentNumbersOfJointsAreAMistakeOfTheCaller) {
    idim_model_interface one = pendulums();
    one.dof = 1;
    EXPECT_THROW(compare_torques(pendulums(), one, ranges()), std::logic_error);
    EXPECT_THROW(compare_torques(pendulums(), pendulums(), {}), std::logic_error);
}

}  // namespace idim
