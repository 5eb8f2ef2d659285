// Joints moved by several coordinates, against the open chain in Orocos KDL: with the joint variables G q + o the
// torque is G' tau(G q + o, G qd, G qdd).
#include <gtest/gtest.h>

#include <random>

#include "description/robot_description.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/expect_dynamics.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

/// A chain whose rows have holes for the joint variables.
struct coupled_chain {
    std::vector<std::string> rows;       ///< with "@" in the place of the variable
    std::vector<std::string> variables;  ///< as written in the coupled robot
    Eigen::MatrixXd G;
    Eigen::VectorXd offset;
};

std::string row_with(const std::string& row, const std::string& variable) {
    std::string text = row;
    return "  - " + text.replace(text.find('@'), 1, variable) + "\n";
}

std::string coupled_text(const coupled_chain& chain) {
    std::string text = "name: coupled\njoints:\n";
    for (std::size_t i = 0; i < chain.rows.size(); ++i) {
        text += row_with(chain.rows[i], "\"" + chain.variables[i] + "\"");
    }
    return text;
}

kdl_robot open_chain(const coupled_chain& chain, const std::vector<rigid_link>& links) {
    std::string text = "name: chain\njoints:\n";
    for (const std::string& row : chain.rows) {
        text += row_with(row, "q");
    }
    const temporary_folder folder;
    return {mdh_table_of(generator::read_robot(folder.write("chain.yaml", text))), links};
}

/// Parameters of links with the labels that the coupled robot gives them.
value_table labelled(const std::vector<rigid_link>& links, const std::vector<std::string>& labels) {
    value_table result;
    for (std::size_t i = 0; i < links.size(); ++i) {
        for (const auto& [name, value] : standard_parameters_of({links[i]})) {
            result[name.substr(0, name.size() - 1) + labels[i]] = value;
        }
    }
    return result;
}

void expect_coupled_dynamics(const coupled_chain& chain, const std::vector<std::string>& labels) {
    const temporary_folder folder;
    const test_model model(folder.write("coupled.yaml", coupled_text(chain)));
    ASSERT_EQ(model.dof(), chain.G.cols());
    std::mt19937_64 random(21);
    const std::vector<rigid_link> links = plausible_links(static_cast<int>(chain.rows.size()), random);
    const kdl_robot oracle = open_chain(chain, links);
    expect_dynamics(model, model.regroup(labelled(links, labels)), [&](const joint_state& s) {
        const joint_state joints = {chain.G * s.q + chain.offset, chain.G * s.qd, chain.G * s.qdd};
        return Eigen::VectorXd(chain.G.transpose() * oracle.inverse_dynamics(joints));
    });
}

std::string error_of(const std::string& joints) {
    const temporary_folder folder;
    try {
        generator::find_base(folder.write("robot.yaml", "name: robot\njoints:\n" + joints), templates_folder);
    } catch (const input_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(CoupledJoints, AParallelogramKeepsItsForearmLevel) {
    Eigen::MatrixXd G(4, 3);
    G << 1, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, -1;
    expect_coupled_dynamics({{"{name: j1, theta: @, r: 0.3}", "{name: j2, alpha: pi/2, theta: @}",
                              "{name: j3, d: 0.4, theta: @}", "{name: level, d: 0.35, theta: @, r: 0.02}"},
                             {"q", "q", "q - q_j2 + 0.2", "pi/2 - q_j3"},
                             G,
                             Eigen::Vector4d(0.0, 0.0, 0.2, 1.5707963267948966)},
                            {"1", "2", "3", "_level"});
}

TEST(CoupledJoints, AMotorMayTurnAJointFurtherInward) {
    Eigen::MatrixXd G(3, 3);
    G << 1, 0, 0.5, 0, 2, 0, 0, -0.25, 1;
    expect_coupled_dynamics({{"{name: j1, theta: @}", "{name: j2, alpha: -pi/2, d: 0.1, theta: @, r: 0.2}",
                              "{name: j3, alpha: 0.7, theta: @, r: 0.1}"},
                             {"q + q_j3/2", "2*q", "q - q_j2/4"},
                             G,
                             Eigen::Vector3d::Zero()},
                            {"1", "2", "3"});
}

TEST(CoupledJoints, ARackMovesWithItsPinion) {
    Eigen::MatrixXd G(3, 2);
    G << 1, 0, 0.1, 0, 0, 1;
    expect_coupled_dynamics({{"{name: pinion, theta: @}", "{name: rack, type: prismatic, alpha: pi/2, d: 0.1, r: @}",
                              "{name: tool, alpha: pi/2, d: 0.2, theta: @}"},
                             {"q", "0.05 + 0.1*q_pinion", "q"},
                             G,
                             Eigen::Vector3d(0.0, 0.05, 0.0)},
                            {"1", "_rack", "2"});
}

TEST(CoupledJoints, FrictionOfAJointWithoutCoordinateActsOnThoseThatMoveIt) {
    const temporary_folder folder;
    const test_model model(folder.write("coupled.yaml",
                                        "name: coupled\njoints:\n"
                                        "  - {name: j1, theta: q}\n  - {name: j2, d: 0.4, theta: q}\n"
                                        "  - {name: level, d: 0.3, theta: -q_j1 - 2*q_j2}\n"
                                        "effects: [{effect: viscous_friction, joints: [level]},\n"
                                        "          {effect: coulomb_friction, joints: [level]},\n"
                                        "          {effect: rotor_inertia, joints: [level]}]\n"));
    const Eigen::VectorXd chi = model.regroup({{"Fv_level", 0.3}, {"Fc_level", 0.7}, {"Ia_level", 0.2}});
    std::mt19937_64 random(22);
    for (int k = 0; k < 20; ++k) {
        const joint_state s = random_state(2, random);
        const Eigen::Vector2d g(-1.0, -2.0);
        const double rate = g.dot(s.qd);
        const double torque = 0.3 * rate + 0.7 * (rate > 0.0 ? 1.0 : -1.0) + 0.2 * g.dot(s.qdd);
        EXPECT_LE(deviation(model.inverse_dynamics(s, chi), g * torque), 1e-13);  // rounding of some operations
    }
}

TEST(CoupledJoints, ALinkWithoutMassHasNoParameters) {
    const temporary_folder folder;
    const std::string rows =
        "  - {name: j1, theta: q}\n  - {name: j2, alpha: pi/2, theta: q, massless: true}\n"
        "  - {name: j3, alpha: -pi/2, d: 0.2, theta: q}\n";
    const test_model model(folder.write("universal.yaml", "name: universal\njoints:\n" + rows));
    for (const std::string& name : model.standard_names()) {
        EXPECT_NE(name.back(), '2') << name;
    }
    std::mt19937_64 random(23);
    std::vector<rigid_link> links = plausible_links(3, random);
    links[1] = rigid_link{};
    const std::string chain = rows.substr(0, rows.find(", massless")) + rows.substr(rows.find("}\n  - {name: j3"));
    const kdl_robot oracle(
        mdh_table_of(generator::read_robot(folder.write("chain.yaml", "name: chain\njoints:\n" + chain))), links);
    expect_dynamics(model, model.regroup(standard_parameters_of(links)),
                    [&](const joint_state& s) { return oracle.inverse_dynamics(s); });
}

TEST(CoupledJoints, AnEffectOfTheAngleOfAShiftedJointIsSeenAsGravity) {
    const temporary_folder folder;
    folder.write("compensator.yaml",
                 "effect: compensator\nper: joint\ntorque: Kc*cos(q) + Ks*sin(q)\n"
                 "linear: {Kc: {unit: N*m}, Ks: {unit: N*m}}\n");
    const std::string robot =
        "name: shifted\njoints:\n  - {name: j1, alpha: pi/2, theta: q + 0.3}\n  - {name: j2, d: 0.4, theta: q}\n";
    const auto plain = generator::find_base(folder.write("plain.yaml", robot), templates_folder);
    const auto with = generator::find_base(
        folder.write("with.yaml", robot + "effects: [{effect: compensator, joints: [j1]}]\n"), templates_folder);
    // cos(q1) and sin(q1) are combinations of cos(q1 + 0.3) and sin(q1 + 0.3), which gravity on MX1 and MY1 brings.
    EXPECT_EQ(with.parameters.size(), plain.parameters.size());
    EXPECT_EQ(with.exact_rank, plain.exact_rank);
}

TEST(CoupledJoints, OnlyCoordinatesCanBeNamed) {
    const std::string first = "  - {name: j1, theta: q}\n  - {name: j2, d: 0.4, theta: -q_j1}\n";
    const std::string unknown = error_of(first + "  - {name: j3, d: 0.4, theta: 2*q_j2}\n");
    EXPECT_NE(unknown.find("robot.yaml:5: joints[3].theta: expression \"2*q_j2\": unknown symbol \"q_j2\""),
              std::string::npos)
        << unknown;
    const std::string product = error_of(first + "  - {name: j3, d: 0.4, theta: q*q_j1}\n");
    EXPECT_NE(product.find("\"q*q_j1\" given, expected a constant times q plus a constant"), std::string::npos)
        << product;
    const std::string vanishing = error_of(first + "  - {name: j3, d: 0.4, theta: q - q + q_j1}\n");
    EXPECT_NE(vanishing.find("\"q - q + q_j1\" given, expected"), std::string::npos) << vanishing;
    const std::string length = error_of(first + "  - {name: j3, d: q_j1, theta: q}\n");
    EXPECT_NE(length.find("robot.yaml:5: joints[3].d: expression \"q_j1\": unknown symbol \"q_j1\""), std::string::npos)
        << length;
}

}  // namespace idim::test
