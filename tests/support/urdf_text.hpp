#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "oracles/mdh_row.hpp"
#include "oracles/rigid_link.hpp"

namespace idim::test {

using triple = std::array<double, 3>;

/// Where an element of a URDF stands: translation [m], then roll, pitch, yaw [rad] about fixed axes.
struct urdf_origin {
    triple xyz = {0.0, 0.0, 0.0};
    triple rpy = {0.0, 0.0, 0.0};
};

inline Eigen::Matrix3d rotation_of(const triple& rpy) {
    return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

inline double draw(double bound, std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(-bound, bound)(random);
}

inline triple draw_triple(double bound, std::mt19937_64& random) {
    return {draw(bound, random), draw(bound, random), draw(bound, random)};
}

/// A URDF that grows element by element; numbers are written so that they read back exactly.
class urdf_text {
  public:
    explicit urdf_text(const std::string& name) : text_("<robot name=\"" + name + "\">\n") {}

    urdf_text& massless_link(const std::string& name) {
        text_ += "  <link name=\"" + name + "\"/>\n";
        return *this;
    }

    /// The inertial frame is turned by `rpy` against the link's.
    urdf_text& link(const std::string& name, const rigid_link& body, const triple& rpy = {0.0, 0.0, 0.0}) {
        const Eigen::Matrix3d R = rotation_of(rpy);
        const Eigen::Matrix3d I = R.transpose() * body.central_inertia * R;
        text_ += fmt::format(
            "  <link name=\"{}\">\n    <inertial>\n      {}\n      <mass value=\"{}\"/>\n"
            "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
            "    </inertial>\n  </link>\n",
            name, origin_text({{body.centre.x(), body.centre.y(), body.centre.z()}, rpy}), body.mass, I(0, 0), I(0, 1),
            I(0, 2), I(1, 1), I(1, 2), I(2, 2));
        return *this;
    }

    /// A link with the inertial frame along its principal axes: the tensor is diagonal.
    urdf_text& principal_link(const std::string& name, std::mt19937_64& random) {
        rigid_link body = plausible_links(1, random).front();
        const triple rpy = {draw(3.0, random), draw(3.0, random), draw(3.0, random)};
        const Eigen::Vector3d extent = Eigen::Vector3d(0.08, 0.06, 0.04) + 0.02 * Eigen::Vector3d(body.centre);
        const Eigen::Vector3d second = body.mass * extent.cwiseAbs2();
        const Eigen::Vector3d moments = second.sum() * Eigen::Vector3d::Ones() - second;
        body.central_inertia = rotation_of(rpy) * moments.asDiagonal() * rotation_of(rpy).transpose();
        return link(name, body, rpy);
    }

    /// `more`: further elements of the joint.
    urdf_text& joint(const std::string& name, const std::string& type, const std::string& parent,
                     const std::string& child, const urdf_origin& origin = {}, const triple& axis = {0.0, 0.0, 1.0},
                     const std::string& more = "") {
        const bool has_limits = type == "revolute" || type == "prismatic";
        text_ += fmt::format(
            "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    {}\n"
            "    <axis xyz=\"{} {} {}\"/>\n{}{}  </joint>\n",
            name, type, parent, child, origin_text(origin), axis[0], axis[1], axis[2],
            has_limits ? "    <limit lower=\"-9\" upper=\"9\" effort=\"50\" velocity=\"3\"/>\n" : "", more);
        return *this;
    }

    std::string text() const { return text_ + "</robot>\n"; }

  private:
    static std::string origin_text(const urdf_origin& origin) {
        return fmt::format("<origin xyz=\"{} {} {}\" rpy=\"{} {} {}\"/>", origin.xyz[0], origin.xyz[1], origin.xyz[2],
                           origin.rpy[0], origin.rpy[1], origin.rpy[2]);
    }

    std::string text_;
};

inline urdf_origin random_origin(std::mt19937_64& random) {
    return {draw_triple(0.4, random), draw_triple(3.0, random)};
}

/// The serial chain of a table, its frames as they are in the table: each row is a fixed joint to a massless link, then
/// the joint about or along z. Links l1, l2 .. hang on joints j1, j2 ..
inline std::string urdf_of(const mdh_table& table, const std::vector<rigid_link>& bodies) {
    urdf_text urdf("chain");
    urdf.massless_link("l0");
    for (std::size_t j = 0; j < table.rows.size(); ++j) {
        const mdh_row& row = table.rows[j];
        const std::string number = std::to_string(j + 1);
        urdf.massless_link("before" + number).link("l" + number, bodies.at(j));
        urdf.joint("fixed" + number, "fixed", "l" + std::to_string(j), "before" + number,
                   {{row.d, 0.0, 0.0}, {row.alpha, 0.0, 0.0}});
        urdf.joint("j" + number, row.prismatic ? "prismatic" : "continuous", "before" + number, "l" + number,
                   {{0.0, 0.0, row.r}, {0.0, 0.0, row.theta}});
    }
    return urdf.text();
}

}  // namespace idim::test
