// The dynamics of robots read from URDF, at their own inertias, against two libraries that read the same text and lay
// no frames: Orocos KDL (what urdfdom reads, joint by joint) and MuJoCo (its own URDF reader, Featherstone's
// algorithms).
#include <gtest/gtest.h>

#include <memory>
#include <ostream>

#include "description/robot_description.hpp"
#include "oracles/kdl_tree.hpp"
#include "oracles/mujoco_robot.hpp"
#include "support/expect_dynamics.hpp"
#include "support/random_tree.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

constexpr double quarter_turn = 1.5707963267948966;

/// Model and a-priori parameters of a URDF without effects.
struct rigid_robot {
    explicit rigid_robot(const std::string& urdf) {
        folder.write("robot.urdf", urdf);
        const std::string file = folder.write("robot.yaml", "name: robot\nurdf: robot.urdf\n");
        model = std::make_unique<test_model>(file);
        chi = model->regroup(generator::read_robot(file).parameters);
    }

    std::vector<std::string> joints() const {
        std::vector<std::string> names;
        for (const auto& joint : model->generated().joints) {
            names.push_back(joint.name);
        }
        return names;
    }

    temporary_folder folder;
    std::unique_ptr<test_model> model;
    Eigen::VectorXd chi;
};

std::vector<rigid_link> bodies(int count, unsigned seed) {
    std::mt19937_64 random(seed);
    return plausible_links(count, random);
}

template <class Oracle>
void expect_agreement(const rigid_robot& robot, const Oracle& oracle) {
    expect_dynamics(*robot.model, robot.chi, [&](const joint_state& s) { return oracle.inverse_dynamics(s); });
    std::mt19937_64 random(22);
    for (int k = 0; k < 20; ++k) {
        const Eigen::VectorXd q = random_state(robot.model->dof(), random).q;
        // Rounding of some hundred operations; the oracles turn inertias by quaternions and eigenvectors.
        EXPECT_LE(deviation(robot.model->mass_matrix(q, robot.chi), oracle.mass_matrix(q)), 1e-10);
    }
}

void expect_agreement(const std::string& urdf) {
    const rigid_robot robot(urdf);
    expect_agreement(robot, kdl_tree(urdf, robot.joints()));
    expect_agreement(robot, mujoco_robot(urdf, robot.joints()));
}

// MuJoCo turns inertia tensors to principal axes with an error of 1e-6 rad: what is compared with it has diagonal ones.

/// Seven joints, none parallel or square to another, axes of any length and sign.
std::string oblique_arm() {
    std::mt19937_64 random(31);
    urdf_text urdf("oblique");
    urdf.principal_link("l0", random);
    for (int j = 1; j <= 7; ++j) {
        const std::string number = std::to_string(j);
        urdf.principal_link("l" + number, random);
        urdf.joint("j" + number, j % 2 == 0 ? "continuous" : "revolute", "l" + std::to_string(j - 1), "l" + number,
                   random_origin(random), draw_triple(2.0, random));
    }
    return urdf.text();
}

/// A trunk of two joints with two arms, two legs and a head; hands and feet are fixed, a camera has no inertia.
std::string humanoid() {
    std::mt19937_64 random(34);
    urdf_text urdf("humanoid");
    const auto add = [&](const std::string& name, const std::string& type, const std::string& parent,
                         const urdf_origin& origin, const triple& axis = {0.0, 0.0, 1.0}) {
        urdf.principal_link(name, random);
        urdf.joint(name + "_joint", type, parent, name, origin, axis);
    };
    urdf.massless_link("world");
    add("pelvis", "fixed", "world", {{0.0, 0.0, 0.9}, {0.0, 0.0, 0.3}});
    add("waist", "revolute", "pelvis", {{0.0, 0.0, 0.1}, {}});
    add("chest", "revolute", "waist", {{0.01, 0.0, 0.15}, {}}, {0.0, 1.0, 0.0});
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0.0 ? "left" : "right";
        add(s + "_hip", "revolute", "pelvis", {{0.0, side * 0.1, -0.05}, {}}, {1.0, 0.0, 0.0});
        add(s + "_thigh", "revolute", s + "_hip", {{0.02, 0.0, -0.03}, {side * 0.2, 0.0, 0.0}}, {0.0, 1.0, 0.0});
        add(s + "_shin", "revolute", s + "_thigh", {{0.0, 0.0, -0.4}, {}}, {0.0, 1.0, 0.0});
        add(s + "_foot", "fixed", s + "_shin", {{0.05, 0.0, -0.4}, {0.1, 0.0, 0.0}});
        add(s + "_shoulder", "revolute", "chest", {{0.0, side * 0.2, 0.3}, {}}, {0.0, 2.0, 0.0});
        add(s + "_arm", "revolute", s + "_shoulder", {{0.0, side * 0.05, 0.0}, {quarter_turn, 0.0, 0.0}},
            {0.0, -side, 0.0});
        add(s + "_forearm", "continuous", s + "_arm", {{0.3, 0.0, 0.0}, {0.0, quarter_turn, 0.0}}, {1.0, 0.0, 0.0});
        add(s + "_hand", "fixed", s + "_forearm", {{0.25, 0.0, 0.02}, {0.4, 0.0, -0.2}});
    }
    urdf.massless_link("camera").joint("camera_joint", "fixed", "chest", "camera", {{0.1, 0.0, 0.4}, {0.0, 0.3, 0.0}});
    add("head", "revolute", "camera", {{0.0, 0.0, 0.05}, {0.0, -0.3, 0.0}});
    return urdf.text();
}

/// Prismatic joints at oblique angles, first, between and last, with a bracket.
std::string sliding_arm() {
    std::mt19937_64 random(35);
    urdf_text urdf("sliding");
    urdf.massless_link("l0");
    for (int j = 1; j <= 6; ++j) {
        urdf.principal_link("l" + std::to_string(j), random);
    }
    urdf.joint("j1", "prismatic", "l0", "l1", {{0.1, 0.2, 0.3}, {0.3, 0.4, 0.5}}, {1.0, 1.0, 0.0});
    urdf.joint("j2", "revolute", "l1", "l2", {{0.2, 0.0, 0.1}, {quarter_turn, 0.0, 0.0}}, {0.0, 0.6, -0.8});
    urdf.joint("j3", "prismatic", "l2", "l3", {{0.0, 0.3, 0.1}, {0.0, 0.7, 0.0}}, {0.3, -0.4, 1.2});
    urdf.joint("bracket", "fixed", "l3", "l4", {{0.1, 0.1, 0.0}, {0.2, 0.0, 1.0}});
    urdf.joint("j4", "revolute", "l4", "l5", {{0.0, 0.1, 0.2}, {0.0, 0.0, quarter_turn}}, {1.0, 0.0, 0.0});
    urdf.joint("j5", "prismatic", "l5", "l6", {{0.3, 0.0, 0.0}, {}}, {0.0, 0.0, -1.0});
    return urdf.text();
}

}  // namespace

TEST(UrdfDynamics, OfASevenAxisArmWithObliqueAxesAreThoseOfKdlAndMujoco) {
    expect_agreement(oblique_arm());
}

TEST(UrdfDynamics, OfABranchedTreeAreThoseOfKdlAndMujoco) {
    expect_agreement(humanoid());
}

TEST(UrdfDynamics, OfObliquePrismaticJointsAreThoseOfKdlAndMujoco) {
    expect_agreement(sliding_arm());
}

TEST(UrdfDynamics, OfAPlanarJointAreThoseOfMujoco) {
    std::mt19937_64 random(36);
    urdf_text urdf("cart");
    urdf.massless_link("floor").principal_link("cart", random).principal_link("pole", random);
    urdf.joint("drive", "planar", "floor", "cart", {{0.1, 0.0, 0.2}, {0.3, 0.2, 0.1}}, {1.0, 2.0, 3.0});
    urdf.joint("hinge", "continuous", "cart", "pole", {{0.1, 0.2, 0.3}, {0.5, 0.0, 0.0}}, {0.0, 1.0, 0.0});
    const rigid_robot robot(urdf.text());
    ASSERT_EQ(robot.joints(), (std::vector<std::string>{"drive_x", "drive_y", "drive_yaw", "hinge"}));
    expect_agreement(robot, mujoco_robot(urdf.text(), {"drive_TX", "drive_TY", "drive_RZ", "hinge"}));
}

TEST(UrdfDynamics, OfAFloatingJointAreThoseOfThreeSlidesAndThreeTurns) {
    const std::vector<rigid_link> links = bodies(3, 37);
    const auto with_arm = [&links](urdf_text urdf) {
        urdf.link("body", links[0]).link("upper", links[1]).link("lower", links[2]);
        urdf.joint("shoulder", "revolute", "body", "upper", {{0.2, 0.1, 0.0}, {quarter_turn, 0.0, 0.0}},
                   {0.0, 1.0, 0.0});
        urdf.joint("elbow", "revolute", "upper", "lower", {{0.3, 0.0, 0.1}, {}}, {0.0, 1.0, 0.0});
        return urdf;
    };
    const urdf_origin start = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
    urdf_text floating = with_arm(urdf_text("floating").massless_link("world"));
    floating.joint("free", "floating", "world", "body", start);
    urdf_text parts = with_arm(urdf_text("parts").massless_link("world"));
    const std::vector<std::pair<std::string, triple>> axes = {{"x", {1.0, 0.0, 0.0}},     {"y", {0.0, 1.0, 0.0}},
                                                              {"z", {0.0, 0.0, 1.0}},     {"yaw", {0.0, 0.0, 1.0}},
                                                              {"pitch", {0.0, 1.0, 0.0}}, {"roll", {1.0, 0.0, 0.0}}};
    std::string parent = "world";
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::string child = i + 1 < axes.size() ? "at_" + axes[i].first : "body";
        if (child != "body") {
            parts.massless_link(child);
        }
        parts.joint("free_" + axes[i].first, i < 3 ? "prismatic" : "revolute", parent, child,
                    i == 0 ? start : urdf_origin{}, axes[i].second);
        parent = child;
    }
    const rigid_robot robot(floating.text());
    expect_agreement(robot, kdl_tree(parts.text(), robot.joints()));
}

TEST(UrdfDynamics, OfMimicJointsAreThoseOfTheOpenTreeByVirtualWork) {
    const std::vector<rigid_link> links = bodies(4, 38);
    const auto gripper = [&links](const std::string& rule, const std::string& next_rule) {
        urdf_text urdf("gripper");
        urdf.massless_link("l0").link("l1", links[0]).link("l2", links[1]).link("l3", links[2]).link("l4", links[3]);
        urdf.joint("j4", "revolute", "l3", "l4", {{0.1, 0.0, 0.2}, {0.0, 0.3, 0.0}}, {1.0, 0.0, 0.0});
        urdf.joint("j1", "revolute", "l0", "l1", {{0.0, 0.1, 0.2}, {0.2, 0.0, 0.0}});
        urdf.joint("j2", "revolute", "l1", "l2", {{0.3, 0.0, 0.0}, {quarter_turn, 0.0, 0.0}}, {0.0, 1.0, 0.0}, rule);
        urdf.joint("j3", "prismatic", "l1", "l3", {{0.2, 0.1, 0.0}, {0.0, 0.4, 0.0}}, {0.0, 0.0, -1.0}, next_rule);
        return urdf.text();
    };
    const rigid_robot robot(gripper("<mimic joint=\"j1\" multiplier=\"-2\" offset=\"0.3\"/>",
                                    "<mimic joint=\"j2\" multiplier=\"0.05\" offset=\"0.1\"/>"));
    ASSERT_EQ(robot.joints(), (std::vector<std::string>{"j1", "j4"}));
    const kdl_tree open(gripper("", ""), {"j1", "j2", "j3", "j4"});
    Eigen::MatrixXd G(4, 2);
    G << 1, 0, -2, 0, -0.1, 0, 0, 1;
    const Eigen::Vector4d offset(0.0, 0.3, 0.115, 0.0);
    expect_dynamics(*robot.model, robot.chi, [&](const joint_state& s) {
        const joint_state all = {G * s.q + offset, G * s.qd, G * s.qdd};
        return Eigen::VectorXd(G.transpose() * open.inverse_dynamics(all));
    });
}

TEST(UrdfDynamics, OfABareFileHaveTheFrictionOfItsJoints) {
    const std::vector<rigid_link> links = bodies(2, 39);
    urdf_text urdf("rubbing");
    urdf.massless_link("l0").link("l1", links[0]).link("l2", links[1]);
    urdf.joint("j1", "revolute", "l0", "l1", {}, {0.0, 0.0, 1.0}, "<dynamics damping=\"0.7\" friction=\"0.2\"/>");
    urdf.joint("j2", "prismatic", "l1", "l2", {}, {1.0, 0.0, 0.0}, "<dynamics damping=\"11\"/>");
    const temporary_folder folder;
    const std::string file = folder.write("rubbing.urdf", urdf.text());
    const test_model model(file);
    const Eigen::VectorXd chi = model.regroup(generator::read_robot(file).parameters);
    const kdl_tree oracle(urdf.text(), {"j1", "j2"});
    std::mt19937_64 random(40);
    for (int k = 0; k < 20; ++k) {
        const joint_state s = random_state(2, random);
        const Eigen::Vector2d friction(0.7 * s.qd[0] + std::copysign(0.2, s.qd[0]), 11.0 * s.qd[1]);
        EXPECT_LE(deviation(model.inverse_dynamics(s, chi), oracle.inverse_dynamics(s) + friction), 1e-10);
    }
}

TEST(UrdfDynamics, OfAJointThatMovesNothingHaveNoForwardModelWithoutARotor) {
    urdf_text urdf("end");
    urdf.massless_link("l0").link("l1", bodies(1, 42).front()).massless_link("tip");
    urdf.joint("j1", "continuous", "l0", "l1")
        .joint("j2", "continuous", "l1", "tip", {{0.3, 0.0, 0.0}, {quarter_turn, 0.0, 0.0}});
    const rigid_robot robot(urdf.text());
    const kdl_tree oracle(urdf.text(), robot.joints());
    std::mt19937_64 random(43);
    const joint_state s = random_state(2, random);
    const Eigen::VectorXd tau = oracle.inverse_dynamics(s);
    EXPECT_LE(deviation(robot.model->inverse_dynamics(s, robot.chi), tau), 1e-10);
    int pivot = 0;
    robot.model->forward_dynamics(s, tau, robot.chi, pivot);
    EXPECT_EQ(pivot, 2);

    const test_model driven(robot.folder.write(
        "driven.yaml", "name: driven\nurdf: robot.urdf\neffects: [{effect: rotor_inertia, joints: [j2]}]\n"));
    value_table parameters = generator::read_robot(robot.folder.path() / "driven.yaml").parameters;
    parameters["Ia2"] = 0.1;
    const Eigen::VectorXd chi = driven.regroup(parameters);
    EXPECT_LE(deviation(driven.forward_dynamics(s, tau + Eigen::Vector2d(0.0, 0.1 * s.qdd[1]), chi, pivot), s.qdd),
              1e-10);
    EXPECT_EQ(pivot, 0);
}

TEST(UrdfDynamics, OfRandomTreesAreThoseOfKdl) {
    std::mt19937_64 random(41);
    for (int k = 0; k < 10; ++k) {
        const std::string urdf = random_tree(5, {"revolute", "continuous", "prismatic", "fixed"}, random);
        const rigid_robot robot(urdf);
        const kdl_tree oracle(urdf, robot.joints());
        for (int i = 0; i < 20; ++i) {
            const joint_state s = random_state(robot.model->dof(), random);
            EXPECT_LE(deviation(robot.model->inverse_dynamics(s, robot.chi), oracle.inverse_dynamics(s)), 1e-10)
                << urdf;
            EXPECT_LE(deviation(robot.model->mass_matrix(s.q, robot.chi), oracle.mass_matrix(s.q)), 1e-10) << urdf;
        }
    }
}

}  // namespace idim::test
