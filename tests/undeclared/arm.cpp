#include "undeclared/arm.hpp"

#include <Eigen/QR>
#include <numbers>
#include <stdexcept>

namespace idim::undeclared {

namespace {

using std::numbers::pi;

constexpr double right_angle = pi / 2.0;

Eigen::Matrix3d about_another_point(const solid& body, const Eigen::Vector3d& point) {
    const Eigen::Vector3d a = body.centre - point;
    return body.central_inertia + body.mass * (a.squaredNorm() * Eigen::Matrix3d::Identity() - a * a.transpose());
}

std::vector<chain_row> rows_of(const std::string& kind, sampler& random) {
    const double a = random.uniform(0.25, 0.6), b = random.uniform(0.2, 0.5), c = random.uniform(0.1, 0.3);
    const double shoulder = random.chance(0.5) ? random.uniform(0.05, 0.3) : 0.0;
    const double elbow = random.chance(0.5) ? random.uniform(0.03, 0.2) : 0.0;
    if (kind == "scara" || kind == "vertical") {
        return {{}, {.d = a}};
    }
    if (kind == "scara4") {
        return {{}, {.d = a}, {.d = b, .prismatic = true}, {}};
    }
    if (kind == "3r") {
        return {{}, {.alpha = right_angle, .d = shoulder}, {.d = a}};
    }
    if (kind == "ppr") {
        const double turn = random.pick({0.0, -right_angle});
        return {{.prismatic = true}, {.alpha = right_angle, .prismatic = true}, {.alpha = turn, .d = c}};
    }
    if (kind == "gantry") {
        return {{.prismatic = true}, {.alpha = right_angle, .prismatic = true}};
    }
    if (kind == "6r") {
        return {{},
                {.alpha = right_angle, .d = shoulder},
                {.d = a},
                {.alpha = -right_angle, .d = elbow, .r = b},
                {.alpha = right_angle},
                {.alpha = -right_angle, .r = c}};
    }
    if (kind == "7r") {
        return {{},
                {.alpha = right_angle},
                {.alpha = -right_angle, .r = a},
                {.alpha = -right_angle, .d = elbow},
                {.alpha = right_angle, .d = -elbow, .r = b},
                {.alpha = right_angle},
                {.alpha = -right_angle}};
    }
    throw std::invalid_argument("no robot of kind " + kind);
}

Eigen::Vector3d gravity_of(const std::string& kind) {
    if (kind == "scara") {
        return Eigen::Vector3d::Zero();
    }
    return kind == "vertical" ? Eigen::Vector3d(0.0, -9.81, 0.0) : Eigen::Vector3d(0.0, 0.0, -9.81);
}

}  // namespace

solid solid::operator+(const solid& other) const {
    solid both;
    both.mass = mass + other.mass;
    both.centre = (mass * centre + other.mass * other.centre) / both.mass;
    both.central_inertia = about_another_point(*this, both.centre) + about_another_point(other, both.centre);
    return both;
}

solid random_solid(double mass, double size, sampler& random) {
    Eigen::Matrix3d directions;
    Eigen::Vector3d second_moments;
    solid body;
    body.mass = mass;
    for (int i = 0; i < 3; ++i) {
        body.centre[i] = size * random.uniform(-0.8, 0.8);
        second_moments[i] = mass * std::pow(size * random.uniform(0.3, 0.8), 2);
        for (int j = 0; j < 3; ++j) {
            directions(i, j) = random.normal();
        }
    }
    const Eigen::Matrix3d axes = Eigen::HouseholderQR<Eigen::Matrix3d>(directions).householderQ();
    const Eigen::Matrix3d covariance = axes * second_moments.asDiagonal() * axes.transpose();
    body.central_inertia = covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
    return body;
}

arm random_arm(const std::string& kind, sampler& random) {
    arm robot;
    robot.kind = kind;
    robot.gravity = gravity_of(kind);
    robot.rows = rows_of(kind, random);
    const double heaviest = random.uniform(5.0, 25.0);
    const int last = std::max(1, robot.dof() - 1);
    for (int j = 0; j < robot.dof(); ++j) {
        const double outward = static_cast<double>(j) / last;
        const double mass = heaviest * std::pow(random.uniform(0.08, 0.2), outward);
        robot.links.push_back(random_solid(mass, 0.18 * std::pow(0.4, outward), random));
        drive one;
        const bool prismatic = robot.rows[static_cast<std::size_t>(j)].prismatic;
        one.position_limit = prismatic ? random.uniform(0.15, 0.4) : random.uniform(0.9, 2.4);
        one.velocity_limit = prismatic ? random.uniform(0.4, 1.0) : random.uniform(1.2, 2.5) * (1.0 + 0.5 * outward);
        robot.drives.push_back(one);
        if (!prismatic && robot.kind != "scara" && random.chance(0.3)) {
            robot.rows[static_cast<std::size_t>(j)].theta = random.uniform(-1.5, 1.5);
        }
    }
    return robot;
}

}  // namespace idim::undeclared
