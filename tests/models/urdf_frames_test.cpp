// Frames laid on the axes of a URDF: they carry every link where the URDF puts it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <random>

#include "description/robot_description.hpp"
#include "description/urdf/urdf_reader.hpp"
#include "oracles/text_value.hpp"
#include "support/random_tree.hpp"
#include "support/temporary_folder.hpp"

namespace idim::test {

namespace {

using generator::urdf_joint;
using generator::urdf_joint_type;
using generator::urdf_tree;
using pose = Eigen::Isometry3d;

pose turned(const Eigen::Vector3d& axis, double angle) {
    return pose(Eigen::AngleAxisd(angle, axis));
}
pose moved(const Eigen::Vector3d& by) {
    return pose(Eigen::Translation3d(by));
}

Eigen::Vector3d vector_of(const triple& v) {
    return {v[0], v[1], v[2]};
}

pose motion_of(const urdf_joint& joint, const value_table& q) {
    const Eigen::Vector3d axis = vector_of(joint.axis).normalized();
    const auto value = [&](const std::string& suffix) { return q.at("q_" + joint.name + suffix); };
    switch (joint.type) {
        case urdf_joint_type::revolute:
            return turned(axis, value(""));
        case urdf_joint_type::prismatic:
            return moved(value("") * axis);
        case urdf_joint_type::planar: {
            const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).matrix();
            return moved(R * Eigen::Vector3d(value("_x"), value("_y"), 0.0)) * turned(axis, value("_yaw"));
        }
        case urdf_joint_type::floating:
            return moved({value("_x"), value("_y"), value("_z")}) * turned(Eigen::Vector3d::UnitZ(), value("_yaw")) *
                   turned(Eigen::Vector3d::UnitY(), value("_pitch")) * turned(Eigen::Vector3d::UnitX(), value("_roll"));
        case urdf_joint_type::fixed:
            break;
    }
    return pose::Identity();
}

/// Poses of all links by their names, from the URDF.
std::map<std::string, pose> written_poses(const urdf_tree& tree, const value_table& q) {
    std::map<std::string, pose> poses = {{tree.links[static_cast<std::size_t>(tree.root)].name, pose::Identity()}};
    while (poses.size() < tree.links.size()) {
        for (const urdf_joint& joint : tree.joints) {
            const auto parent = poses.find(tree.links[static_cast<std::size_t>(joint.parent)].name);
            if (parent != poses.end()) {
                const pose at = moved(vector_of(joint.xyz)) * pose(Eigen::Affine3d(rotation_of(joint.rpy)).matrix());
                poses[tree.links[static_cast<std::size_t>(joint.child)].name] =
                    parent->second * at * motion_of(joint, q);
            }
        }
    }
    return poses;
}

pose row_pose(const generator::joint_description& row, value_table names) {
    const auto found = names.find("q_" + row.name);
    names["q"] = found == names.end() ? 0.0 : found->second;
    const auto value = [&](const generator::expression_text& entry) { return text_value(entry.text, names); };
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    return turned(z, value(row.gamma)) * moved(value(row.b) * z) * turned(x, value(row.alpha)) *
           moved(value(row.d) * x) * turned(z, value(row.theta)) * moved(value(row.r) * z);
}

/// Where our rows and placements put the links.
std::map<std::string, pose> laid_poses(const generator::robot_description& robot, const value_table& q) {
    std::vector<pose> frames;
    std::map<std::string, pose> poses;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
        const auto& row = robot.joints[j];
        const pose before = row.antecedent < 0 ? pose::Identity() : frames[static_cast<std::size_t>(row.antecedent)];
        frames.push_back(before * row_pose(row, q));
        const auto& placement = robot.links[j];
        if (!placement.link.empty()) {
            Eigen::Affine3d local = Eigen::Affine3d::Identity();
            for (Eigen::Index i = 0; i < 3; ++i) {
                for (Eigen::Index k = 0; k < 3; ++k) {
                    local.linear()(i, k) = placement.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
                }
            }
            local.translation() = vector_of(placement.position);
            poses[placement.link] = frames.back() * pose(local.matrix());
        }
    }
    return poses;
}

value_table random_coordinates(const generator::robot_description& robot, std::mt19937_64& random) {
    value_table q;
    for (const auto& joint : robot.joints) {
        if (generator::has_own_coordinate(joint)) {
            q["q_" + joint.name] = draw(3.0, random);
        }
    }
    return q;
}

void expect_same_poses(const std::string& urdf, std::mt19937_64& random) {
    const temporary_folder folder;
    const std::string file = folder.write("tree.urdf", urdf);
    const generator::robot_description robot = generator::read_robot(file);
    const urdf_tree tree = generator::read_urdf(file);
    for (int k = 0; k < 5; ++k) {
        const value_table q = random_coordinates(robot, random);
        const std::map<std::string, pose> written = written_poses(tree, q);
        for (const auto& [link, laid] : laid_poses(robot, q)) {
            // Rounding of some ten rotations and lengths of some metres.
            EXPECT_LE((laid.matrix() - written.at(link).matrix()).cwiseAbs().maxCoeff(), 1e-12) << link << "\n" << urdf;
        }
    }
}

}  // namespace

TEST(UrdfFrames, CarryTheLinksOfRandomTreesWhereTheUrdfPutsThem) {
    std::mt19937_64 random(61);
    for (int k = 0; k < 300; ++k) {
        expect_same_poses(random_tree(8, {"revolute", "continuous", "prismatic", "fixed"}, random), random);
    }
}

TEST(UrdfFrames, CarryTheLinksOfPlanarAndFloatingJointsWhereTheUrdfPutsThem) {
    std::mt19937_64 random(62);
    for (int k = 0; k < 100; ++k) {
        expect_same_poses(random_tree(5, {"planar", "floating", "revolute"}, random), random);
    }
}

namespace {

/// gamma b alpha d theta r of each row of a chain of revolute joints about z.
std::vector<std::array<std::string, 6>> rows_of(const std::vector<urdf_origin>& origins) {
    urdf_text urdf("chain");
    urdf.massless_link("l0");
    for (std::size_t j = 0; j < origins.size(); ++j) {
        const std::string number = std::to_string(j + 1);
        urdf.massless_link("l" + number);
        urdf.joint("j" + number, "continuous", "l" + std::to_string(j), "l" + number, origins[j]);
    }
    const temporary_folder folder;
    std::vector<std::array<std::string, 6>> rows;
    for (const auto& row : generator::read_robot(folder.write("chain.urdf", urdf.text())).joints) {
        rows.push_back({row.gamma.text, row.b.text, row.alpha.text, row.d.text, row.theta.text, row.r.text});
    }
    return rows;
}

}  // namespace

TEST(UrdfFrames, AreThoseOfClassicTablesWhereAxesHaveNoOffsets) {
    const std::vector<std::array<std::string, 6>> rows = {{"0", "0", "0", "0", "q", "0.3"},
                                                          {"0", "0", "pi/2", "0", "q", "0"},
                                                          {"0", "0", "0", "0.4", "q + pi/2", "0"},
                                                          {"0", "0", "-pi/2", "0.25", "q", "0"}};
    EXPECT_EQ(rows_of({{{0.0, 0.0, 0.3}, {}},
                       {{0.0, 0.0, 0.0}, {1.5708, 0.0, 0.0}},
                       {{0.4, 0.0, 0.0}, {0.0, 0.0, 1.5708}},
                       {{0.25, 0.0, 0.0}, {-1.5708, 0.0, 0.0}}}),
              rows);
}

TEST(UrdfFrames, CarryOffsetsAlongAxesOutwardUpToTheWrist) {
    const std::vector<std::array<std::string, 6>> rows = {{"0", "0", "0", "0", "q", "0.3"},
                                                          {"0", "0", "pi/2", "0", "q", "0"},
                                                          {"0", "0.1", "-pi/2", "0", "q", "0"},
                                                          {"0", "0", "pi/2", "0", "q", "0.2"},
                                                          {"0", "0", "-pi/2", "0", "q", "0"}};
    EXPECT_EQ(rows_of({{{0.0, 0.0, 0.3}, {}},
                       {{0.0, 0.0, 0.0}, {1.5708, 0.0, 0.0}},
                       {{0.0, 0.0, 0.1}, {-1.5708, 0.0, 0.0}},
                       {{0.0, 0.0, 0.0}, {1.5708, 0.0, 0.0}},
                       {{0.0, 0.0, 0.2}, {-1.5708, 0.0, 0.0}}}),
              rows);
}

}  // namespace idim::test
