#include "idim/motion_limits.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "excitation/sampled_model.hpp"
#include "uniform_numbers.hpp"

namespace idim {

namespace {

void widen(limit_breach& largest, double share, const std::string& limit) {
    // A motion that is no number keeps no limit.
    const double safe = std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
    if (safe > largest.share) {
        largest = {safe, limit};
    }
}

void widen_by_box(limit_breach& largest, const limited_robot& robot, const workspace_box& box,
                  const motion_samples& motion) {
    const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
    const Eigen::Vector3d half = 0.5 * (box.high - box.low);
    double share = -1.0;
    for (Eigen::Index k = 0; k < motion.q.rows(); ++k) {
        const Eigen::Vector3d place = point_of_link(robot.links, box.link, box.point, motion.q.row(k).transpose());
        share = std::max(share, ((place - centre).cwiseAbs().cwiseQuotient(half)).maxCoeff() - 1.0);
    }
    widen(largest, share, box.name);
}

motion_samples at_rest(const Eigen::VectorXd& q) {
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(1, q.size());
    return {Eigen::VectorXd::Zero(1), q.transpose(), none, none};
}

}  // namespace

limit_breach largest_breach(const limited_robot& robot, const motion_samples& motion) {
    const motion_limits& limits = robot.limits;
    const Eigen::VectorXd centre = limits.centre();
    const Eigen::VectorXd half = limits.half_range();
    limit_breach largest{-1.0, ""};
    const Eigen::MatrixXd tau = robot.limits_torque() ? sampled_torque(robot.model, motion, robot.chi)
                                                      : Eigen::MatrixXd::Zero(1, motion.q.cols());
    for (Eigen::Index j = 0; j < motion.q.cols(); ++j) {
        const std::string joint = robot.model.joint_names[j];
        const auto largest_of = [](const auto& values) { return values.cwiseAbs().maxCoeff(); };
        widen(largest, largest_of((motion.q.col(j).array() - centre[j]).matrix()) / half[j] - 1.0,
              "position of " + joint);
        widen(largest, largest_of(motion.qd.col(j)) / limits.velocity[j] - 1.0, "velocity of " + joint);
        widen(largest, largest_of(motion.qdd.col(j)) / limits.acceleration[j] - 1.0, "acceleration of " + joint);
        widen(largest, largest_of(tau.col(j)) / limits.torque[j] - 1.0, "torque of " + joint);
    }
    for (const workspace_box& box : limits.boxes) {
        widen_by_box(largest, robot, box, motion);
    }
    return largest;
}

rest_choice choose_rest(const limited_robot& robot, std::uint64_t seed) {
    constexpr int random_positions = 4000;
    constexpr int refinements = 4000;
    // Space for a motion around the rest.
    constexpr double wanted = -0.2;
    const Eigen::VectorXd half = robot.limits.half_range();
    rest_choice best{robot.limits.centre(), {}};
    best.breach = largest_breach(robot, at_rest(best.q));
    uniform_numbers uniform(seed);
    const auto consider = [&](const Eigen::VectorXd& q) {
        const limit_breach breach = largest_breach(robot, at_rest(q));
        if (breach.share < best.breach.share) {
            best = {q, breach};
            return true;
        }
        return false;
    };
    for (int k = 0; k < random_positions && best.breach.share > wanted; ++k) {
        consider(robot.limits.centre() + half.cwiseProduct(uniform.vector(half.size())));
    }
    // Random steps whose length follows their success (Schumer and Steiglitz 1968).
    double step = 0.2;
    for (int k = 0; k < refinements && best.breach.share > wanted; ++k) {
        const Eigen::VectorXd q = best.q + step * half.cwiseProduct(uniform.vector(half.size()));
        step = consider(q) ? std::min(1.0, step * 1.5) : std::max(1e-7, step * 0.97);
    }
    return best;
}

}  // namespace idim
