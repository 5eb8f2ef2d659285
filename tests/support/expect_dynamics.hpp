#pragma once

#include <gtest/gtest.h>

#include <random>

#include "support/test_model.hpp"

namespace idim::test {

/// All models of `model` at random states against the torques that `expected` gives.
template <class F>
void expect_dynamics(const test_model& model, const Eigen::VectorXd& chi, const F& expected) {
    std::mt19937_64 random(16);
    for (int k = 0; k < 50; ++k) {
        joint_state s = random_state(model.dof(), random);
        const Eigen::VectorXd tau = expected(s);
        EXPECT_LE(deviation(model.inverse_dynamics(s, chi), tau), 1e-10);  // rounding of some hundred operations
        EXPECT_LE(deviation(model.regressor(s) * chi, tau), 1e-10);
        int pivot = -1;
        EXPECT_LE(deviation(model.forward_dynamics(s, tau, chi, pivot), s.qdd), 1e-10);
        EXPECT_EQ(pivot, 0);
        const Eigen::VectorXd inertial = model.mass_matrix(s.q, chi) * s.qdd;
        s.qdd.setZero();
        const Eigen::VectorXd still = expected(s);
        EXPECT_LE(deviation(model.bias(s, chi), still), 1e-10);
        EXPECT_LE(deviation(inertial, tau - still), 1e-10);
        s.qd.setZero();
        EXPECT_LE(deviation(model.gravity(s.q, chi), expected(s)), 1e-10);
    }
}

}  // namespace idim::test
