#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "idim/model_interface.h"

namespace idim {

/// Where a joint is taken in a comparison: q in [q_min, q_max], |qd| <= qd_max, |qdd| <= qdd_max [rad, m and their
/// derivatives].
struct joint_range {
    double q_min = 0.0, q_max = 0.0;
    double qd_max = 0.0;
    double qdd_max = 0.0;
};

/// One joint at one state: what both models say.
struct torque_difference {
    double value = 0.0;  ///< absolute [N*m or N], or relative; infinite where only one torque is a number
    int joint = 0;
    Eigen::VectorXd q, qd, qdd;
    double before = 0.0, after = 0.0;  ///< [N*m or N]
};

enum class torque_verdict { same, same_up_to_rounding, different };

/// A standard parameter that one model lacks, and the joints whose torque it moves in the other.
struct one_sided_parameter {
    std::string name;
    std::vector<int> joints;
};

struct torque_comparison {
    torque_verdict verdict = torque_verdict::same;
    int states = 0;
    std::uint64_t seed = 0;
    torque_difference absolute;  ///< the largest difference
    torque_difference relative;  ///< the largest part of the largest torque that either model has at that joint
    std::vector<one_sided_parameter> only_before, only_after;
};

/// Largest relative difference that counts as rounding. Sums taken in another order (Newton-Euler against regressor
/// times parameters) differ by less than 1e-15 for the robots of this repository; longer chains lose some digits more.
/// A constant changed in its eleventh digit shows.
inline constexpr double torque_rounding = 1e-12;

/// Do two models of robots with the same joints compute the same torque?
///
/// Evaluates both inverse dynamic models at random states. At each the standard parameters that both have, by name, are
/// drawn from [-1, 1] (SI units), those that only one has are zero, and each model regroups them for itself. Time is
/// drawn from [0, 100] s and temperatures from [0, 60] degC. The same seed gives the same states on every machine.
/// `ranges` has one entry for each joint. Throws std::logic_error where the numbers of joints differ.
torque_comparison compare_torques(const idim_model_interface& before, const idim_model_interface& after,
                                  const std::vector<joint_range>& ranges, int states = 2000, std::uint64_t seed = 1);

}  // namespace idim
