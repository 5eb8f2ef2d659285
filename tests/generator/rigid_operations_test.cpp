#include "backend/rigid_operations.hpp"

#include <gtest/gtest.h>

namespace idim::generator {

namespace {

/// Counts of the graphs below were taken by hand from the expressions beside them.
class RigidOperations : public testing::Test {
  protected:
    signed_node parameter(const char* name, int index) { return graph_.symbol({name, symbol_role::parameter, index}); }
    signed_node leaf(const char* name, symbol_role role) { return graph_.symbol({name, role, 0}); }

    expression_graph graph_;
};

void expect(const operation_count& found, int mul, int add, int div, int functions) {
    EXPECT_EQ(found.mul, mul);
    EXPECT_EQ(found.add, add);
    EXPECT_EQ(found.div, div);
    EXPECT_EQ(found.functions, functions);
}

TEST_F(RigidOperations, ParametersOfEffectsAreZero) {
    const signed_node qd = leaf("qd1", symbol_role::velocity);
    const signed_node qdd = leaf("qdd1", symbol_role::acceleration);
    // ZZ1 qdd + Fv1 qd + Fc1 sign(qd)
    const signed_node inertia = graph_.multiply(parameter("ZZ1", 0), qdd);
    const signed_node viscous = graph_.multiply(parameter("Fv1", 1), qd);
    const signed_node coulomb = graph_.multiply(parameter("Fc1", 2), graph_.function(function_kind::sign, qd));
    graph_.output("tau", 0, graph_.add(graph_.add(inertia, viscous), coulomb));
    expect(rigid_operations(graph_, {true, true, true}), 3, 2, 0, 1);
    expect(rigid_operations(graph_, {true, false, true}), 2, 1, 0, 1);
    expect(rigid_operations(graph_, {true, false, false}), 1, 0, 0, 0);
}

TEST_F(RigidOperations, ColumnsOfEffectsAreLeftOutOfARegressor) {
    const signed_node qd = leaf("qd1", symbol_role::velocity);
    const signed_node qdd = leaf("qdd1", symbol_role::acceleration);
    // two rows of (qd qdd, qd^2)
    graph_.output("W", 0, graph_.multiply(qd, qdd));
    graph_.output("W", 1, graph_.multiply(qd, qd));
    graph_.output("W", 2, graph_.multiply(graph_.constant(2), graph_.multiply(qd, qdd)));
    graph_.output("W", 3, graph_.multiply(graph_.constant(3), graph_.multiply(qd, qd)));
    expect(rigid_operations(graph_, {true, true}), 4, 0, 0, 0);
    expect(rigid_operations(graph_, {false, true}), 2, 0, 0, 0);
}

TEST_F(RigidOperations, ACoordinateThatMovesNothingButItsDriveHasNoEquationWithoutIt) {
    const signed_node tau1 = graph_.symbol({"tau1", symbol_role::torque, 0});
    const signed_node tau2 = graph_.symbol({"tau2", symbol_role::torque, 1});
    // tau1 / ZZ1 and tau2 / Ia2
    graph_.output("qdd", 0, graph_.divide(tau1, parameter("ZZ1", 0)));
    graph_.output("qdd", 1, graph_.divide(tau2, parameter("Ia2", 1)));
    expect(rigid_operations(graph_, {true, true}), 0, 0, 2, 0);
    expect(rigid_operations(graph_, {true, false}), 0, 0, 1, 0);
}

}  // namespace

}  // namespace idim::generator
