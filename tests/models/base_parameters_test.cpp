// Which standard parameters can be identified, and how the others are regrouped: published counts and names, closed
// rules, and the rank of a regressor that Orocos KDL computed.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <random>
#include <regex>

#include "base_parameters/base_parameter_set.hpp"
#include "oracles/effect_terms.hpp"
#include "oracles/kdl_robot.hpp"
#include "oracles/serial_regrouping.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

const char* const no_effects = "[]";
const char* const friction_effects = "[viscous_friction, coulomb_friction]";
const char* const rotors = "[rotor_inertia]";
const char* const rotors_friction = "[rotor_inertia, viscous_friction, coulomb_friction]";
const char* const everything = "[rotor_inertia, viscous_friction, coulomb_friction, torque_offset]";

generator::base_report base_of(const std::string& robot, const char* effects) {
    const temporary_folder folder;
    return generator::find_base(write_variant(folder, robot, effects), templates_folder);
}

std::size_t count(const std::string& robot, const char* effects) {
    const generator::base_report base = base_of(robot, effects);
    EXPECT_EQ(static_cast<int>(base.parameters.size()), base.qr_rank);
    EXPECT_EQ(base.exact_rank, base.qr_rank);
    return base.parameters.size();
}

std::vector<std::string> names_of(const generator::base_report& base) {
    std::vector<std::string> names;
    for (const auto& parameter : base.parameters) {
        names.push_back(parameter.name);
    }
    return names;
}

std::string kept_name(const std::string& base_name) {
    return base_name.back() == 'R' ? base_name.substr(0, base_name.size() - 1) : base_name;
}

class Regrouping : public testing::TestWithParam<std::string> {};
class Rank : public testing::TestWithParam<std::string> {};

std::string robot_name(const testing::TestParamInfo<std::string>& robot) {
    return robot.param;
}

/// W_st by KDL and closed forms at random states; after the links' columns, n for each of Ia, Fv, Fc, off.
Eigen::MatrixXd sampled_regressor(const mdh_table& table) {
    const auto n = static_cast<Eigen::Index>(table.rows.size());
    const Eigen::Index samples = 2 * 14;  // twice the columns of one joint
    Eigen::MatrixXd W(samples * n, 14 * n);
    std::mt19937_64 random(11);
    for (Eigen::Index k = 0; k < samples; ++k) {
        const joint_state s = random_state(n, random);
        W.block(k * n, 0, n, 10 * n) = kdl_regressor(table, s);
        Eigen::Index column = 10 * n;
        for (const char* kind : {"Ia", "Fv", "Fc", "off"}) {
            for (Eigen::Index j = 0; j < n; ++j) {
                W.block(k * n, column++, n, 1) = effect_torque({{kind + std::to_string(j + 1), 1.0}}, s);
            }
        }
    }
    return W;
}

struct rank_by_svd {
    Eigen::Index rank = 0;
    double smallest_counted = 0.0, largest_left = 0.0;  ///< relative singular values
};

rank_by_svd find_rank(Eigen::MatrixXd W) {
    for (Eigen::Index c = 0; c < W.cols(); ++c) {
        const double norm = W.col(c).norm();
        W.col(c) /= norm > 1e-9 ? norm : 1.0;
    }
    const Eigen::VectorXd s = Eigen::BDCSVD<Eigen::MatrixXd>(W).singularValues() / W.norm();
    rank_by_svd found;
    found.rank = (s.array() > 1e-9).count();
    found.smallest_counted = s[found.rank - 1];
    found.largest_left = found.rank < s.size() ? s[found.rank] : 0.0;
    return found;
}

std::vector<std::string> serial_robots() {
    std::vector<std::string> names = open_robot_names();
    // Effects of its own take the place of the catalogue's there (robots/scara/README.md); counted below.
    names.erase(std::remove(names.begin(), names.end(), "scara"), names.end());
    return names;
}

TEST(BaseParameters, ScaraHasEightOfThemFourRigid) {
    EXPECT_EQ(generator::find_base(robot_file("scara"), templates_folder).parameters.size(), 8u);  // [IV 52]
    EXPECT_EQ(count("scara", no_effects), 4u);
}

TEST(BaseParameters, DensoHasThePublishedCounts) {
    EXPECT_EQ(count("denso_vp6242g", no_effects), 36u);
    EXPECT_EQ(count("denso_vp6242g", friction_effects), 48u);
    EXPECT_EQ(generator::find_base(robot_file("denso_vp6242g"), templates_folder).parameters.size(), 48u);
}

TEST(BaseParameters, GeneralSixAxisRobotsHaveThePublishedCounts) {
    for (const char* robot : {"puma560", "rx90", "tx40", "ur5", "denso_vp6242g"}) {
        EXPECT_EQ(count(robot, no_effects), 36u) << robot;
        EXPECT_EQ(count(robot, rotors), 40u) << robot;
        EXPECT_EQ(count(robot, rotors_friction), 52u) << robot;
        EXPECT_EQ(count(robot, everything), 58u) << robot;
    }
}

TEST(BaseParameters, SevenAxisRobotsHaveThePublishedCounts) {
    for (const char* robot : {"kuka_lwr", "panda", "xmate7p", "kinova_gen3"}) {
        EXPECT_EQ(count(robot, no_effects), 43u) << robot;
        EXPECT_EQ(count(robot, rotors), 48u) << robot;
        EXPECT_EQ(count(robot, rotors_friction), 62u) << robot;
        EXPECT_EQ(count(robot, everything), 69u) << robot;
    }
}

TEST(BaseParameters, LinksWithoutMassLeaveTheFrictionOfEachJoint) {
    // Few columns a joint: at too few states a joint turns the same way in all of them, and its Coulomb friction would
    // pass for an offset.
    const std::string massless =
        std::regex_replace(read_text(robot_file("kinova_gen3")), std::regex("\\{name: j"), "{massless: true, name: j");
    const temporary_folder folder;
    const std::string file = folder.write("kinova_gen3.yaml", massless);
    EXPECT_EQ(generator::find_base(file, templates_folder).parameters.size(), 28u);
}

TEST(BaseParameters, StanfordHasThirtyThreeRigidOnes) {
    EXPECT_EQ(count("stanford", no_effects), 33u);
}

TEST(BaseParameters, Tx40AsDeclaredHasFiftyEight) {
    // 36 rigid, Ia3 to Ia6, 12 of friction and 6 offsets. The published 60 has the three parameters of the wrist
    // coupling besides and no Ia6, which regroups with the coupling's rotor inertia there.
    EXPECT_EQ(generator::find_base(robot_file("tx40"), templates_folder).parameters.size(), 58u);
}

TEST(BaseParameters, DensoHasThePublishedNamesInThePublishedOrder) {
    // [CWLS], table IV, whose Fs is Fc here and which puts Fs before Fv.
    const std::vector<std::string> published = {"ZZ1R",                                                 //
                                                "Fv1",  "Fc1",                                          //
                                                "XX2R", "XY2",  "XZ2R", "YZ2", "ZZ2R", "MX2R", "MY2",   //
                                                "Fv2",  "Fc2",                                          //
                                                "XX3R", "XY3R", "XZ3",  "YZ3", "ZZ3R", "MX3R", "MY3R",  //
                                                "Fv3",  "Fc3",                                          //
                                                "XX4R", "XY4",  "XZ4",  "YZ4", "ZZ4R", "MX4",  "MY4R",  //
                                                "Fv4",  "Fc4",                                          //
                                                "XX5R", "XY5",  "XZ5",  "YZ5", "ZZ5R", "MX5",  "MY5R",  //
                                                "Fv5",  "Fc5",                                          //
                                                "XX6R", "XY6",  "XZ6",  "YZ6", "ZZ6",  "MX6",  "MY6",   //
                                                "Fv6",  "Fc6"};
    EXPECT_EQ(names_of(generator::find_base(robot_file("denso_vp6242g"), templates_folder)), published);
}

/// regroup() of the generated code against the closed rules, at random standard parameters.
void expect_closed_rules(const std::string& file) {
    const test_model model(file);
    const mdh_table table = mdh_table_of(generator::read_robot(file));
    std::mt19937_64 random(1990);
    for (int k = 0; k < 20; ++k) {
        value_table standard;
        for (const std::string& name : model.standard_names()) {
            standard[name] = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
        }
        const value_table expected = regroup_serial(table, standard);
        const Eigen::VectorXd chi = model.regroup(standard);
        const std::vector<std::string> names = model.parameter_names();
        ASSERT_EQ(names.size(), expected.size());
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto rule = expected.find(kept_name(names[i]));
            ASSERT_NE(rule, expected.end()) << names[i];
            // Sums of up to 15 terms of order one.
            EXPECT_NEAR(chi[static_cast<Eigen::Index>(i)], rule->second, 1e-13) << names[i];
        }
    }
}

TEST_P(Regrouping, FollowsTheClosedRulesOfGautierAndKhalil) {
    expect_closed_rules(robot_file(GetParam()));
}

TEST(RegroupingOfObliqueAxes, FollowsTheClosedRulesByFormulasProvenInRationals) {
    const temporary_folder folder;
    const std::string file = folder.write("oblique.yaml",
                                          "name: oblique\n"
                                          "constants: {d: 0.3, r: 0.1, D: 0.2}\n"
                                          "joints:\n"
                                          "  - {name: j1, theta: q}\n"
                                          "  - {name: j2, alpha: pi/2, d: d, theta: q, r: r}\n"
                                          "  - {name: j3, alpha: 0.8, d: D, theta: q, r: 0.35}\n"
                                          "  - {name: j4, alpha: -1.1, d: 0.15, theta: q + 0.3, r: r}\n");
    const generator::base_report base = generator::find_base(file, templates_folder);
    EXPECT_EQ(base.modulo_prime_only, 0);
    const auto mx2 = std::find_if(base.parameters.begin(), base.parameters.end(),
                                  [](const generator::parameter_context& p) { return p.name == "MX2R"; });
    ASSERT_NE(mx2, base.parameters.end());
    EXPECT_EQ(mx2->regroups, "MX2 + D*M3 + D*M4");
    expect_closed_rules(file);
}

TEST(RegroupingAcrossMasslessLinks, IsByFormulasInTheConstantsBetween) {
    // A universal joint: the second link has no mass, and the axes of joints 2 and 3 meet in a point that both link 1
    // and link 3 hold. A mass there belongs to either: M3 - h MZ3 + h^2 (XX3 + YY3) = d^2 ZZ1 + d MX1.
    const temporary_folder folder;
    const generator::base_report base =
        generator::find_base(folder.write("universal.yaml",
                                          "name: universal\nconstants: {d: 0.3, h: 0.2}\njoints:\n"
                                          "  - {name: j1, alpha: pi/2, theta: q}\n"
                                          "  - {name: j2, alpha: pi/2, d: d, theta: q, massless: true}\n"
                                          "  - {name: j3, alpha: pi/2, theta: q, r: h}\n"),
                             templates_folder);
    EXPECT_EQ(base.modulo_prime_only, 0);
    EXPECT_EQ(base.standard, 20);
    std::map<std::string, std::string> regrouped;
    for (const generator::parameter_context& parameter : base.parameters) {
        if (parameter.name != parameter.regroups) {
            regrouped[parameter.name] = parameter.regroups;
        }
    }
    const std::map<std::string, std::string> expected = {{"ZZ1R", "ZZ1 + d^2*M3"},
                                                         {"MX1R", "MX1 + d*M3"},
                                                         {"XX3R", "XX3 - h^2*M3"},
                                                         {"YY3R", "YY3 - h^2*M3"},
                                                         {"MZ3R", "MZ3 + h*M3"}};
    EXPECT_EQ(regrouped, expected);
}

TEST(CoupledJoints, HaveTheRankOfTheKdlRegressorOfTheirCoordinates) {
    // A link that turns with the base of its parallelogram and one that turns twice against the third: the angles q2,
    // q3 - q2 and 2 q3 are not independent.
    const temporary_folder folder;
    const std::string head = "name: coupled\njoints:\n  - {name: j1, theta: q}\n";
    const auto rows = [](const std::string& third, const std::string& fourth) {
        return "  - {name: j2, alpha: pi/2, d: 0.3, theta: q}\n  - {name: j3, d: 0.4, theta: " + third +
               "}\n  - {name: j4, d: 0.2, theta: " + fourth + "}\n";
    };
    const generator::base_report coupled =
        generator::find_base(folder.write("coupled.yaml", head + rows("q - q_j2", "-2*q_j3")), templates_folder);
    const mdh_table table = mdh_table_of(generator::read_robot(folder.write("free.yaml", head + rows("q", "q"))));
    Eigen::MatrixXd G(4, 3);  // joint velocities by coordinates
    G << 1, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, -2;
    Eigen::MatrixXd W(3 * 30, 40);
    std::mt19937_64 random(13);
    for (Eigen::Index k = 0; k < 30; ++k) {
        const joint_state s = random_state(3, random);
        W.middleRows(3 * k, 3) = G.transpose() * kdl_regressor(table, {G * s.q, G * s.qd, G * s.qdd});
    }
    const rank_by_svd svd = find_rank(W);
    EXPECT_EQ(static_cast<Eigen::Index>(coupled.parameters.size()), svd.rank);
    EXPECT_EQ(coupled.exact_rank, coupled.qr_rank);
    EXPECT_GT(svd.smallest_counted, 1e-6);
    EXPECT_LT(svd.largest_left, 1e-13);
}

TEST(RigidLinksAlone, HaveTheOperationsOfTheRobotWithoutEffects) {
    const auto counts = [](const generator::operation_table& table) {
        std::vector<int> numbers;
        for (const generator::operation_count& c :
             {table.inverse_dynamics, table.regressor, table.mass_matrix, table.forward_dynamics}) {
            numbers.insert(numbers.end(), {c.mul, c.add, c.div, c.functions});
        }
        return numbers;
    };
    for (const std::string& robot : robot_names()) {
        const temporary_folder folder;
        const std::string without = write_variant(folder, robot, no_effects);
        EXPECT_EQ(counts(generator::generate(robot_file(robot), templates_folder).rigid_operations),
                  counts(generator::generate(without, templates_folder).operations))
            << robot;
    }
}

INSTANTIATE_TEST_SUITE_P(RevoluteRobots, Regrouping,
                         testing::Values("denso_vp6242g", "puma560", "rx90", "tx40", "ur5", "panda", "kuka_lwr",
                                         "xmate7p"),
                         robot_name);

TEST_P(Rank, IsThatOfARegressorByKdl) {
    const mdh_table table = mdh_table_of(generator::read_robot(robot_file(GetParam())));
    const auto n = static_cast<Eigen::Index>(table.rows.size());
    const Eigen::MatrixXd W = sampled_regressor(table);
    const std::pair<const char*, Eigen::Index> cases[] = {
        {no_effects, 10}, {rotors, 11}, {rotors_friction, 13}, {everything, 14}};
    for (const auto& [effects, columns] : cases) {
        const rank_by_svd svd = find_rank(W.leftCols(columns * n));
        EXPECT_EQ(static_cast<Eigen::Index>(count(GetParam(), effects)), svd.rank) << effects;
        // A gap of seven decades: the count does not hang on where it is cut.
        EXPECT_GT(svd.smallest_counted, 1e-6) << effects;
        EXPECT_LT(svd.largest_left, 1e-13) << effects;
    }
}

INSTANTIATE_TEST_SUITE_P(Robots, Rank, testing::ValuesIn(serial_robots()), robot_name);

TEST(RankOfScara, IsThatOfARegressorByKdl) {
    const mdh_table table = mdh_table_of(generator::read_robot(robot_file("scara")));
    const Eigen::MatrixXd W = sampled_regressor(table);
    EXPECT_EQ(find_rank(W.leftCols(20)).rank, 4);
    EXPECT_EQ(find_rank(W.leftCols(22)).rank, 5);  // rotor_inertia at both: Ia1 regroups, Ia2 does not
    EXPECT_EQ(count("scara", no_effects), 4u);
    EXPECT_EQ(count("scara", rotors), 5u);
}

TEST(NearlySpecialGeometry, ARightAngleInDecimalsKeepsTheBaseParametersOfTheRightAngle) {
    const temporary_folder folder;
    const auto names = [&folder](const std::string& alpha) {
        const std::string text = "name: near\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, alpha: " + alpha +
                                 ", theta: q}\n  - {name: j3, alpha: 0, d: 0.4, theta: q}\n";
        return names_of(generator::find_base(folder.write("near.yaml", text), templates_folder));
    };
    // The angle itself decides nothing here: only parallel axes are special.
    EXPECT_EQ(names("1.5707963"), names("pi/2"));
    EXPECT_EQ(names("1.5707963267948966"), names("pi/2"));
}

TEST(NearlySpecialGeometry, AlmostParallelAxesAreRefusedWithBothRanks) {
    const temporary_folder folder;
    const auto planar = [&folder](const std::string& alpha) {
        return folder.write(
            "near.yaml", "name: near\ngravity: [0, 0, 0]\njoints:\n  - {name: j1, theta: q}\n  - {name: j2, alpha: " +
                             alpha + ", d: 0.5, theta: q}\n");
    };
    EXPECT_EQ(generator::find_base(planar("0"), templates_folder).parameters.size(), 4u);
    EXPECT_EQ(generator::find_base(planar("0.01"), templates_folder).parameters.size(), 8u);
    try {
        generator::find_base(planar("1e-9"), templates_folder);
        FAIL() << "rank of nearly parallel axes decided in silence";
    } catch (const generator::rank_disagreement& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("rank 4 by QR"), std::string::npos) << message;
        EXPECT_NE(message.find("8 in exact arithmetic"), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

}  // namespace

}  // namespace idim::test
