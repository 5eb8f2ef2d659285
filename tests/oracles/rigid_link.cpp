#include "oracles/rigid_link.hpp"

#include <Eigen/Geometry>
#include <string>

namespace idim::test {

std::vector<rigid_link> plausible_links(int count, std::mt19937_64& random) {
    const auto between = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<rigid_link> links;
    for (int j = 0; j < count; ++j) {
        rigid_link link;
        link.mass = between(0.5, 8.0);
        Eigen::Vector3d extent;
        Eigen::Vector4d turn;
        for (int i = 0; i < 3; ++i) {
            link.centre[i] = between(-0.15, 0.15);
            extent[i] = between(0.02, 0.15);
        }
        for (double& component : turn) {
            component = between(-1.0, 1.0);
        }
        const Eigen::Matrix3d axes = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
        const Eigen::Matrix3d second = link.mass * axes * extent.cwiseAbs2().asDiagonal() * axes.transpose();
        link.central_inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
        links.push_back(link);
    }
    return links;
}

value_table standard_parameters_of(const std::vector<rigid_link>& links) {
    value_table values;
    for (std::size_t j = 0; j < links.size(); ++j) {
        const rigid_link& link = links[j];
        const std::string number = std::to_string(j + 1);
        const Eigen::Vector3d& c = link.centre;
        const Eigen::Matrix3d I =
            link.central_inertia + link.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
        values["XX" + number] = I(0, 0);
        values["XY" + number] = I(0, 1);
        values["XZ" + number] = I(0, 2);
        values["YY" + number] = I(1, 1);
        values["YZ" + number] = I(1, 2);
        values["ZZ" + number] = I(2, 2);
        values["MX" + number] = link.mass * c.x();
        values["MY" + number] = link.mass * c.y();
        values["MZ" + number] = link.mass * c.z();
        values["M" + number] = link.mass;
    }
    return values;
}

}  // namespace idim::test
