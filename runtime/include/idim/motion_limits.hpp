#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "idim/fourier_series.hpp"
#include "idim/model_interface.h"

namespace idim {

/// A point of a link that has to stay in a box, both in the base frame where not said otherwise [m].
struct workspace_box {
    std::string name;       ///< for messages
    int link = 0;           ///< index in limited_robot::links
    Eigen::Vector3d point;  ///< in the frame of the link
    Eigen::Vector3d low, high;
};

/// Where a link's frame stands in that of its parent: Rot(z,gamma) Trans(z,b) Rot(x,alpha) Trans(x,d) Rot(z,theta)
/// Trans(z,r) (Khalil and Kleinfinger 1986), rate * q added to theta or r.
struct link_row {
    int parent = -1;  ///< smaller than the row's own index; -1: the base
    double gamma = 0.0, b = 0.0, alpha = 0.0, d = 0.0, theta = 0.0, r = 0.0;
    bool prismatic = false;
    Eigen::VectorXd rate;  ///< [n]
};

/// What a motion has to keep; infinite where there is no limit [rad or m, per s; N*m or N].
struct motion_limits {
    Eigen::VectorXd lower, upper;                    ///< [n] position, finite
    Eigen::VectorXd velocity, acceleration, torque;  ///< [n]
    std::vector<workspace_box> boxes;

    Eigen::VectorXd centre() const { return 0.5 * (lower + upper); }
    Eigen::VectorXd half_range() const { return 0.5 * (upper - lower); }
};

/// A robot under limits. The model outlives it.
struct limited_robot {
    const idim_model_interface& model;
    motion_limits limits;
    Eigen::VectorXd chi;          ///< [b] base parameters; empty where unknown: then torques are not limited
    std::vector<link_row> links;  ///< needed where there are boxes

    bool limits_torque() const { return chi.size() > 0 && limits.torque.array().isFinite().any(); }
};

/// How far a motion goes past a limit, as a share of that limit (of half the range for positions and boxes); 0 or less
/// where it keeps all.
struct limit_breach {
    double share = 0.0;
    std::string limit;  ///< such as "velocity of j2"
};

/// The limit that the motion is nearest to or furthest past.
limit_breach largest_breach(const limited_robot& robot, const motion_samples& motion);

/// Where the robot rests: the centre of the ranges, or, where a box or the torque of gravity forbids it, what is best
/// of random positions, drawn in by a local search. The breach there is positive where no position keeps the limits.
struct rest_choice {
    Eigen::VectorXd q;  ///< [n]
    limit_breach breach;
};
rest_choice choose_rest(const limited_robot& robot, std::uint64_t seed);

/// Position of a point of a link in the base frame [m]; `jacobian`, where given, is its 3 x n derivative by q.
Eigen::Vector3d point_of_link(const std::vector<link_row>& links, int link, const Eigen::Vector3d& point,
                              const Eigen::VectorXd& q, Eigen::Matrix3Xd* jacobian = nullptr);

}  // namespace idim
