// Branches and fixed joints, against serial chains in Orocos KDL: a branch adds its torques to those of the other, and
// a fixed joint is a revolute one that stands still.
#include <gtest/gtest.h>

#include <random>

#include "description/robot_description.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/expect_dynamics.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

mdh_table table_of(const std::string& rows) {
    const temporary_folder folder;
    return mdh_table_of(generator::read_robot(folder.write("chain.yaml", "name: chain\njoints:\n" + rows)));
}

const std::string root = "  - {name: j1, theta: q, r: 0.3}\n";
const std::string left =
    "  - {name: j2, alpha: pi/2, d: 0.1, theta: q}\n  - {name: j3, d: 0.4, theta: q + 0.3, r: 0.05}\n";
const std::string right =
    "  - {name: j4, gamma: pi/3, alpha: -pi/2, d: 0.2, theta: q}\n  - {name: j5, type: prismatic, alpha: pi/2, r: q + "
    "0.2}\n";

Eigen::VectorXd chosen(const Eigen::VectorXd& v, const std::vector<Eigen::Index>& at) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(at.size()));
    for (std::size_t i = 0; i < at.size(); ++i) {
        result[static_cast<Eigen::Index>(i)] = v[at[i]];
    }
    return result;
}

joint_state chosen(const joint_state& s, const std::vector<Eigen::Index>& at) {
    return {chosen(s.q, at), chosen(s.qd, at), chosen(s.qdd, at)};
}

}  // namespace

TEST(TreeStructure, TorquesOfTwoBranchesAddAtTheirRoot) {
    const temporary_folder folder;
    std::string second = right;
    second.replace(second.find("name: j4"), 8, "name: j4, antecedent: j1");
    const test_model model(folder.write("tree.yaml", "name: tree\njoints:\n" + root + left + second));
    std::mt19937_64 random(17);
    const std::vector<rigid_link> links = plausible_links(5, random);
    const kdl_robot first_branch(table_of(root + left), {links[0], links[1], links[2]});
    const kdl_robot second_branch(table_of(root + right), {rigid_link{}, links[3], links[4]});
    expect_dynamics(model, model.regroup(standard_parameters_of(links)), [&](const joint_state& s) {
        const Eigen::VectorXd a = first_branch.inverse_dynamics(chosen(s, {0, 1, 2}));
        const Eigen::VectorXd b = second_branch.inverse_dynamics(chosen(s, {0, 3, 4}));
        return Eigen::VectorXd((Eigen::VectorXd(5) << a[0] + b[0], a[1], a[2], b[1], b[2]).finished());
    });
}

TEST(TreeStructure, AFixedJointIsARevoluteOneThatStandsStill) {
    const temporary_folder folder;
    const std::string bracket = "alpha: 0.4, d: 0.15, r: 0.1, ";
    const std::string wrist = "  - {name: j3, alpha: -pi/2, d: 0.2, theta: q}\n";
    const std::string arm = root + "  - {name: j2, alpha: pi/2, theta: q}\n";
    const test_model model(folder.write("arm.yaml", "name: arm\njoints:\n" + arm + "  - {name: bracket, type: fixed, " +
                                                        bracket + "theta: pi/2}\n" + wrist));
    std::mt19937_64 random(18);
    const std::vector<rigid_link> links = plausible_links(4, random);
    // The bracket is the third link of the chain, "_bracket" among the parameters; link 3 is the chain's fourth.
    value_table standard = standard_parameters_of({links[0], links[1], links[3]});
    for (const auto& [name, value] : standard_parameters_of({links[2]})) {
        standard[name.substr(0, name.size() - 1) + "_bracket"] = value;
    }
    const kdl_robot chain(table_of(arm + "  - {name: bracket, " + bracket + "theta: q + pi/2}\n" + wrist), links);
    expect_dynamics(model, model.regroup(standard), [&](const joint_state& s) {
        const auto widened = [](const Eigen::VectorXd& v) {
            return Eigen::VectorXd(Eigen::Vector4d(v[0], v[1], 0.0, v[2]));
        };
        return chosen(chain.inverse_dynamics({widened(s.q), widened(s.qd), widened(s.qdd)}), {0, 1, 3});
    });
}

}  // namespace idim::test
