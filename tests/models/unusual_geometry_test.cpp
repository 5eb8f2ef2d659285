// Entries of a description that no robot of robots/ has, against Orocos KDL: gamma and b, oblique angles, joints that
// turn backwards or by a ratio, zero positions in pi, tilted gravity.
#include <gtest/gtest.h>

#include <random>

#include "description/robot_description.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

struct unusual_robot {
    const char* name;
    const char* text;
};

std::ostream& operator<<(std::ostream& stream, const unusual_robot& robot) {
    return stream << robot.name;
}

const unusual_robot unusual_robots[] = {
    {"ObliqueAxesWithGammaAndB",
     "name: oblique\nconstants: {L: 0.3, a: 0.4, g: 0.6}\njoints:\n"
     "  - {name: j1, alpha: 0.2, d: 0.1, theta: q, r: 0.15}\n"
     "  - {name: j2, gamma: g, b: 0.12, alpha: a, d: L, theta: q + pi/6, r: -0.1}\n"
     "  - {name: j3, alpha: -pi/2, d: L*sin(a), theta: q - 0.3, r: L*sqrt(2)}\n"},
    {"GammaAndBAtEveryJoint",
     "name: turned\nconstants: {b1: 0.1, b2: 0.2, b3: 0.3}\njoints:\n"
     "  - {name: j1, gamma: 0.3, b: b1, theta: q}\n"
     "  - {name: j2, gamma: -0.5, b: b2, alpha: pi/2, theta: q}\n"
     "  - {name: j3, gamma: pi/2, b: -b3, alpha: pi/2, theta: q, d: 0.25}\n"},
    {"JointsThatTurnBackwardsOrByARatio",
     "name: geared\nconstants: {ratio: 3}\njoints:\n"
     "  - {name: j1, theta: -q}\n"
     "  - {name: j2, alpha: pi/2, theta: 2*q + pi/3, d: 0.2}\n"
     "  - {name: j3, alpha: -pi/2, type: prismatic, theta: 0.7, r: -q/2 + 0.25, d: 0.1}\n"
     "  - {name: j4, alpha: 0.5, theta: pi/2 - q/ratio, r: 0.3}\n"},
    {"GravityThatIsTilted",
     "name: tilted\ngravity: [9.81*sin(pi/7), -1.5, -9.81*cos(pi/7)]\njoints:\n"
     "  - {name: j1, theta: q}\n"
     "  - {name: j2, alpha: pi/2, theta: q, d: 0.1, r: 0.2}\n"
     "  - {name: j3, theta: q, d: 0.4}\n"},
    {"PrismaticJointsAlone",
     "name: gantry\njoints:\n"
     "  - {name: x, type: prismatic, alpha: pi/2, r: q}\n"
     "  - {name: y, type: prismatic, alpha: pi/2, theta: pi/2, r: q + 0.5}\n"
     "  - {name: z, type: prismatic, gamma: 0.3, alpha: 0.8, theta: -0.4, d: 0.3, r: 1 - q}\n"},
    {"ParallelAxesInAnyDirection",
     "name: planar\ngravity: [0, -9.81, 0]\njoints:\n"
     "  - {name: j1, theta: q}\n"
     "  - {name: j2, d: 0.5, theta: q, r: 0.1}\n"
     "  - {name: j3, d: 0.4, theta: q + pi/4, r: -0.2}\n"},
};

class UnusualGeometry : public testing::TestWithParam<unusual_robot> {};

TEST_P(UnusualGeometry, HasTheDynamicsOfKdl) {
    const temporary_folder folder;
    const std::string file = folder.write("robot.yaml", GetParam().text);
    const test_model model(file);
    const mdh_table table = mdh_table_of(generator::read_robot(file));
    std::mt19937_64 random(14);
    const std::vector<rigid_link> links = plausible_links(static_cast<int>(table.rows.size()), random);
    const kdl_robot oracle(table, links);
    const Eigen::VectorXd chi = model.regroup(standard_parameters_of(links));
    for (int k = 0; k < 50; ++k) {
        const joint_state s = random_state(model.dof(), random);
        const Eigen::VectorXd tau = oracle.inverse_dynamics(s);
        // Rounding of some hundred operations, as for the robots of robots/.
        EXPECT_LE(deviation(model.inverse_dynamics(s, chi), tau), 1e-10);
        EXPECT_LE(deviation(model.regressor(s) * chi, tau), 1e-10);
        EXPECT_LE(deviation(model.mass_matrix(s.q, chi), oracle.mass_matrix(s.q)), 1e-10);
        EXPECT_LE(deviation(model.gravity(s.q, chi), oracle.gravity(s.q)), 1e-10);
        int pivot = -1;
        EXPECT_LE(deviation(model.forward_dynamics(s, tau, chi, pivot), s.qdd), 1e-10);
        EXPECT_EQ(pivot, 0);
    }
}

TEST_P(UnusualGeometry, ComparisonSeesAMillimetreAndAMilliradian) {
    // Guards the comparison above: it would fail for a geometry that is a little off.
    const temporary_folder folder;
    const mdh_table table = mdh_table_of(generator::read_robot(folder.write("robot.yaml", GetParam().text)));
    std::mt19937_64 random(15);
    const std::vector<rigid_link> links = plausible_links(static_cast<int>(table.rows.size()), random);
    mdh_table off = table;
    off.rows.back().alpha += 1e-3;
    off.rows[1].d += 1e-3;
    const joint_state s = random_state(static_cast<Eigen::Index>(table.rows.size()), random);
    EXPECT_GE(deviation(kdl_robot(off, links).inverse_dynamics(s), kdl_robot(table, links).inverse_dynamics(s)), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Robots, UnusualGeometry, testing::ValuesIn(unusual_robots),
                         [](const testing::TestParamInfo<unusual_robot>& robot) {
                             return std::string(robot.param.name);
                         });

}  // namespace

}  // namespace idim::test
