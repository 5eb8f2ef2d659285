#pragma once

#include <Eigen/Core>
#include <random>

namespace idim::test {

/// Positions [rad or m], velocities and accelerations of all joints.
struct joint_state {
    Eigen::VectorXd q, qd, qdd;
};

/// Positions over a whole turn, velocities to 2 and accelerations to 5 in SI units.
inline joint_state random_state(Eigen::Index joints, std::mt19937_64& random) {
    const auto draw = [&](double bound) {
        Eigen::VectorXd v(joints);
        for (double& x : v) {
            x = std::uniform_real_distribution<double>(-bound, bound)(random);
        }
        return v;
    };
    joint_state state;
    state.q = draw(3.14);
    state.qd = draw(2.0);
    state.qdd = draw(5.0);
    return state;
}

}  // namespace idim::test
