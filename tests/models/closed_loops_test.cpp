// Closed loops against the tree in MuJoCo, whose passive joints are found by Newton's method, and against a Lagrangian
// of circles that intersect.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "description/robot_description.hpp"
#include "oracles/mujoco_loops.hpp"
#include "support/c_library.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

// Of the largest torque of all states. The oracle's drifts are fourth differences over milliradians: 1e-12.
constexpr double against_mujoco = 1e-10;
constexpr double loops_against_themselves = 1e-10;

struct loop_robot {
    const char* name;
    const char* text;
    std::vector<int> fourth;  ///< corner of each parallelogram
    bool has_roots = true;
};

std::ostream& operator<<(std::ostream& stream, const loop_robot& robot) {
    return stream << robot.name;
}

const loop_robot loop_robots[] = {
    {"FiveBarUnderGravity",
     "name: five_bar\ngravity: [0, -9.81, 0]\nconstants: {L: 0.3}\njoints:\n"
     "  - {name: j1, theta: q + 0.2}\n"
     "  - {name: j2, antecedent: base, d: 0.2, theta: q}\n"
     "  - {name: j3, antecedent: j1, d: L, theta: q}\n"
     "  - {name: j4, antecedent: j2, d: 0.25, theta: q}\n"
     "loops:\n"
     "  - {cut: [{link: j3, point: [0.5, 0.1, 0]}, {link: j4, point: [0.45, 0, 0]}], passive: [j3, j4], assembly: 1}\n",
     {}},
    {"FiveBarOnATurntableThatFlipsAnAxis",
     "name: turntable\njoints:\n"
     "  - {name: table, theta: q}\n"
     "  - {name: j1, gamma: 0.3, alpha: pi/2, b: 0.4, theta: q}\n"
     "  - {name: j2, antecedent: table, gamma: 0.3, alpha: -pi/2, d: 0.2, b: 0.4, r: 0.1, theta: q}\n"
     "  - {name: j3, antecedent: j1, d: 0.3, theta: q, r: 0.05}\n"
     "  - {name: j4, antecedent: j2, alpha: pi, d: 0.25, theta: q}\n"
     "loops:\n"
     "  - cut: [{link: j4, point: [0.45, 0, 0.2]}, {link: j3, point: [0.5, 0.1, 0.05]}]\n"
     "    passive: [j4, j3]\n"
     "    assembly: -1\n",
     {}},
    {"FourBarWithTheCutAtTheCoupler",
     "name: four_bar\nconstants: {crank: 0.15, coupler: 0.5, rocker: 0.4, ground: 0.55}\ngravity: [0, -9.81, 0]\n"
     "joints:\n"
     "  - {name: crank, theta: q}\n"
     "  - {name: coupler, d: crank, theta: q}\n"
     "  - {name: rocker, antecedent: base, d: ground, theta: q}\n"
     "loops:\n"
     "  - cut: [{link: coupler, point: [coupler, 0, 0]}, {link: rocker, point: [rocker, 0, 0]}]\n"
     "    passive: [coupler, rocker]\n"
     "    assembly: -1\n",
     {}},
    {"FourBarWithTheCutAtTheGround",
     "name: four_bar\ngravity: [1, -9.81, 0]\njoints:\n"
     "  - {name: crank, theta: -q}\n"
     "  - {name: coupler, d: 0.15, theta: q}\n"
     "  - {name: rocker, alpha: pi, d: 0.5, theta: q}\n"
     "loops:\n"
     "  - cut: [{link: base, point: [0.5, 0.2, 0]}, {link: rocker, point: [0.4, 0, 0]}]\n"
     "    passive: [coupler, rocker]\n"
     "    assembly: 1\n",
     {}},
    {"ACylinderThatLiftsABoom",
     "name: boom\ngravity: [0, -9.81, 0]\njoints:\n"
     "  - {name: boom, theta: q}\n"
     "  - {name: stick, d: 0.8, theta: q}\n"
     "  - {name: tube, antecedent: base, d: 0.3, theta: q}\n"
     "  - {name: piston, type: prismatic, alpha: pi/2, r: q + 0.5, limits: {position: [-0.2, 0.2]}}\n"
     "loops:\n"
     "  - cut: [{link: boom, point: [0.4, 0.1, 0]}, {link: piston, point: [0.02, 0, 0.1]}]\n"
     "    passive: [boom, tube]\n"
     "    assembly: -1\n",
     {}},
    {"AFourBarThatCarriesAnother",
     "name: chain\ngravity: [0, -9.81, 0]\njoints:\n"
     "  - {name: crank, theta: q}\n"
     "  - {name: coupler, d: 0.15, theta: q}\n"
     "  - {name: rocker, antecedent: base, d: 0.55, theta: q}\n"
     "  - {name: j2, antecedent: coupler, d: 0.6, theta: q}\n"
     "  - {name: j3, d: 0.2, theta: q}\n"
     "  - {name: j4, antecedent: coupler, d: 0.9, theta: q}\n"
     "loops:\n"
     "  - {cut: [{link: coupler, point: [0.5, 0, 0]}, {link: rocker, point: [0.4, 0, 0]}], passive: [coupler, "
     "rocker],\n"
     "     assembly: 1}\n"
     "  - {cut: [{link: j3, point: [0.5, 0, 0]}, {link: j4, point: [0.45, 0, 0]}], passive: [j3, j4], assembly: 1}\n",
     {}},
    {"AParallelogramOfBentBars",
     "name: parallelogram\ngravity: [0, -9.81, 0]\njoints:\n"
     "  - {name: crank, theta: q}\n"
     "  - {name: coupler, d: 0.3, theta: q}\n"
     "  - {name: rocker, antecedent: base, d: 0.5, theta: q}\n"
     "loops:\n"
     "  - cut: [{link: coupler, point: [0.3, 0.4, 0]}, {link: rocker, point: [0, 0.3, 0]}]\n"
     "    passive: [coupler, rocker]\n"
     "    assembly: parallelogram\n",
     {0},
     false},
};

/// A robot with plausible links, and the same in MuJoCo.
struct loops_under_test {
    loops_under_test(const std::string& text, const std::vector<int>& fourth, std::uint64_t seed)
        : random(seed), file(folder.write("robot.yaml", text)), description(generator::read_robot(file)), model(file) {
        links = plausible_links(static_cast<int>(description.joints.size()), random);
        oracle = std::make_unique<mujoco_loops>(mujoco_loops_of(description, links, fourth));
        for (std::size_t j = 0; j < links.size(); ++j) {
            const std::string label = generator::parameter_label(description.joints, static_cast<int>(j));
            for (const auto& [name, value] : standard_parameters_of({links[j]})) {
                standard[name.substr(0, name.size() - 1) + label] = value;
            }
        }
    }

    /// Where the loops close, not near a singular position.
    joint_state state() {
        for (;;) {
            joint_state s = random_state(model.dof(), random);
            for (Eigen::Index i = 0, j = 0; i < s.q.size(); ++j) {
                const auto& joint = description.joints[static_cast<std::size_t>(j)];
                if (generator::has_own_coordinate(joint)) {
                    s.q[i] = joint.limits.position ? s.q[i] / 3.14 * joint.limits.position->second : s.q[i];
                    ++i;
                }
            }
            const Eigen::VectorXd all = oracle->closed(s.q);
            if (all.size() > 0 && oracle->margin(all) > 0.03) {
                return s;
            }
        }
    }

    std::mt19937_64 random;
    temporary_folder folder;
    std::string file;
    generator::robot_description description;
    test_model model;
    std::vector<rigid_link> links;
    std::unique_ptr<mujoco_loops> oracle;
    value_table standard;
};

/// The first of `loop_robots` by Lagrange's equations, its coupler where two circles intersect.
class five_bar_lagrangian {
  public:
    explicit five_bar_lagrangian(const std::vector<rigid_link>& links) : links_(links) {}

    Eigen::VectorXd torque(const joint_state& s) const {
        constexpr double h = 1e-4;
        Eigen::Vector2d tau = (momentum(s, h) - momentum(s, -h)) / (2.0 * h);
        for (int i = 0; i < 2; ++i) {
            const Eigen::Vector2d e = h * Eigen::Vector2d::Unit(i);
            tau[i] -= (lagrangian(s.q + e, s.qd) - lagrangian(s.q - e, s.qd)) / (2.0 * h);
        }
        return tau;
    }

  private:
    /// Angles of the four bars against x, from the positions of their ends.
    static Eigen::Vector4d angles(const Eigen::Vector2d& q) {
        const Eigen::Vector2d a = 0.3 * Eigen::Vector2d(std::cos(q[0] + 0.2), std::sin(q[0] + 0.2));
        const Eigen::Vector2d b = Eigen::Vector2d(0.2, 0.0) + 0.25 * Eigen::Vector2d(std::cos(q[1]), std::sin(q[1]));
        const double first = std::hypot(0.5, 0.1);
        const double d = (b - a).norm();
        const double along = (first * first + d * d - 0.45 * 0.45) / (2.0 * d);
        const Eigen::Vector2d x = (b - a) / d;
        const Eigen::Vector2d c =
            a + along * x + std::sqrt(first * first - along * along) * Eigen::Vector2d(-x.y(), x.x());
        return Eigen::Vector4d(q[0] + 0.2, q[1], std::atan2(c.y() - a.y(), c.x() - a.x()) - std::atan2(0.1, 0.5),
                               std::atan2(c.y() - b.y(), c.x() - b.x()));
    }

    Eigen::Matrix<double, 2, 4> centres(const Eigen::Vector2d& q) const {
        const Eigen::Vector4d phi = angles(q);
        const std::array<Eigen::Vector2d, 4> origin = {
            Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.2, 0.0),
            0.3 * Eigen::Vector2d(std::cos(phi[0]), std::sin(phi[0])),
            Eigen::Vector2d(0.2, 0.0) + 0.25 * Eigen::Vector2d(std::cos(phi[1]), std::sin(phi[1]))};
        Eigen::Matrix<double, 2, 4> result;
        for (int j = 0; j < 4; ++j) {
            result.col(j) = origin[static_cast<std::size_t>(j)] +
                            Eigen::Rotation2Dd(phi[j]) * links_[static_cast<std::size_t>(j)].centre.head<2>();
        }
        return result;
    }

    double lagrangian(const Eigen::Vector2d& q, const Eigen::Vector2d& qd) const {
        constexpr double h = 1e-5;
        const Eigen::Matrix<double, 2, 4> v = (centres(q + h * qd) - centres(q - h * qd)) / (2.0 * h);
        Eigen::Vector4d w = angles(q + h * qd) - angles(q - h * qd);
        double result = 0.0;
        for (int j = 0; j < 4; ++j) {
            const rigid_link& link = links_[static_cast<std::size_t>(j)];
            const double rate = std::remainder(w[j], 2.0 * M_PI) / (2.0 * h);
            result += 0.5 * link.mass * v.col(j).squaredNorm() + 0.5 * link.central_inertia(2, 2) * rate * rate -
                      9.81 * link.mass * centres(q)(1, j);
        }
        return result;
    }

    /// Of the motion of `s`, a time t later.
    Eigen::Vector2d momentum(const joint_state& s, double t) const {
        const Eigen::Vector2d q = s.q + t * s.qd + t * t / 2.0 * s.qdd;
        const Eigen::Vector2d qd = s.qd + t * s.qdd;
        Eigen::Vector2d p;
        for (int i = 0; i < 2; ++i) {
            const Eigen::Vector2d e = Eigen::Vector2d::Unit(i);
            p[i] = (lagrangian(q, qd + 0.5 * e) - lagrangian(q, qd - 0.5 * e));  // quadratic in qd: exact
        }
        return p;
    }

    const std::vector<rigid_link>& links_;
};

class ClosedLoop : public testing::TestWithParam<loop_robot> {};

void expect_dynamics_of_mujoco(loops_under_test& robot, int count) {
    const test_model& model = robot.model;
    const Eigen::VectorXd chi = model.regroup(robot.standard);
    std::vector<joint_state> states;
    std::vector<Eigen::VectorXd> torques;
    double size = 0.0;  // torques of one joint cancel at some states
    for (int k = 0; k < count; ++k) {
        states.push_back(robot.state());
        torques.push_back(robot.oracle->inverse_dynamics(states.back()));
        size = std::max(size, torques.back().cwiseAbs().maxCoeff());
    }
    for (std::size_t k = 0; k < states.size(); ++k) {
        joint_state s = states[k];
        const Eigen::VectorXd& tau = torques[k];
        EXPECT_LE((model.inverse_dynamics(s, chi) - tau).cwiseAbs().maxCoeff(), against_mujoco * size);
        EXPECT_LE((model.regressor(s) * chi - tau).cwiseAbs().maxCoeff(), against_mujoco * size);
        int pivot = -1;
        EXPECT_LE(deviation(model.forward_dynamics(s, model.inverse_dynamics(s, chi), chi, pivot), s.qdd),
                  loops_against_themselves);
        EXPECT_EQ(pivot, 0);
        const Eigen::VectorXd inertial = model.mass_matrix(s.q, chi) * s.qdd;
        const Eigen::VectorXd all = model.inverse_dynamics(s, chi);
        s.qdd.setZero();
        EXPECT_LE(deviation(model.bias(s, chi), model.inverse_dynamics(s, chi)), loops_against_themselves);
        EXPECT_LE(deviation(inertial, all - model.inverse_dynamics(s, chi)), loops_against_themselves);
        s.qd.setZero();
        EXPECT_LE((model.gravity(s.q, chi) - robot.oracle->inverse_dynamics(s)).cwiseAbs().maxCoeff(),
                  against_mujoco * size);
    }
}

/// Torques of random links at random states, a column for each: their rank is that of the regressor.
Eigen::Index rank_of_torques(const loops_under_test& of, const std::vector<int>& fourth,
                             const std::vector<joint_state>& states) {
    std::mt19937_64 random(12);
    const auto n = static_cast<Eigen::Index>(of.model.dof());
    const auto columns = static_cast<Eigen::Index>(10 * of.links.size() + 5);
    Eigen::MatrixXd torques(n * static_cast<Eigen::Index>(states.size()), columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
        const mujoco_loops robot =
            mujoco_loops_of(of.description, plausible_links(static_cast<int>(of.links.size()), random), fourth);
        for (std::size_t s = 0; s < states.size(); ++s) {
            torques.block(static_cast<Eigen::Index>(s) * n, c, n, 1) = robot.inverse_dynamics(states[s]);
        }
    }
    const Eigen::VectorXd s = Eigen::BDCSVD<Eigen::MatrixXd>(torques).singularValues();
    const Eigen::Index rank = (s.array() > 1e-8 * s[0]).count();
    // A gap of two decades at least: the count does not hang on where it is cut.
    EXPECT_GT(s[rank - 1], 5e-8 * s[0]);
    EXPECT_LT(rank < s.size() ? s[rank] : 0.0, 5e-10 * s[0]);
    return rank;
}

void expect_rank_of_mujoco(loops_under_test& robot, const std::vector<int>& fourth) {
    std::vector<joint_state> states;
    while (states.size() * static_cast<std::size_t>(robot.model.dof()) < 12 * robot.links.size()) {
        states.push_back(robot.state());
    }
    const generator::base_report& base = robot.model.generated().base;
    EXPECT_EQ(static_cast<Eigen::Index>(base.parameters.size()), rank_of_torques(robot, fourth, states));
    EXPECT_EQ(base.exact_rank, base.qr_rank);
}

bool calls(const generator::generated_model& model, const std::string& function) {
    return std::any_of(model.files.begin(), model.files.end(), [&function](const auto& file) {
        return file.name == "inverse_dynamics.hpp" && file.text.find(function) != std::string::npos;
    });
}

TEST_P(ClosedLoop, HasTheDynamicsOfMujoco) {
    loops_under_test robot(GetParam().text, GetParam().fourth, 31);
    expect_dynamics_of_mujoco(robot, 20);
    EXPECT_EQ(calls(robot.model.generated(), "sqrt("), GetParam().has_roots);
}

TEST_P(ClosedLoop, HasAsManyBaseParametersAsTheRegressorHasRank) {
    loops_under_test robot(GetParam().text, GetParam().fourth, 32);
    expect_rank_of_mujoco(robot, GetParam().fourth);
}

TEST_P(ClosedLoop, KeepsItsEnergyWhenNothingDrivesIt) {
    loops_under_test robot(GetParam().text, GetParam().fourth, 33);
    const Eigen::VectorXd chi = robot.model.regroup(robot.standard);
    joint_state s = robot.state();
    const double start = robot.oracle->energy(s.q, s.qd);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(robot.model.dof());
    const auto acceleration = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
        int pivot = -1;
        const Eigen::VectorXd qdd = robot.model.forward_dynamics({q, qd, none}, none, chi, pivot);
        EXPECT_EQ(pivot, 0);
        return qdd;
    };
    constexpr double h = 1e-4;
    for (int k = 0; k < 100; ++k) {  // Runge-Kutta of order four
        const Eigen::VectorXd a = acceleration(s.q, s.qd);
        const Eigen::VectorXd b = acceleration(s.q + h / 2 * s.qd, s.qd + h / 2 * a);
        const Eigen::VectorXd c = acceleration(s.q + h / 2 * s.qd + h * h / 4 * a, s.qd + h / 2 * b);
        const Eigen::VectorXd d = acceleration(s.q + h * s.qd + h * h / 2 * b, s.qd + h * c);
        s.q += h * s.qd + h * h / 6 * (a + b + c);
        s.qd += h / 6 * (a + 2 * b + 2 * c + d);
    }
    EXPECT_NEAR(robot.oracle->energy(s.q, s.qd), start, 1e-8 * std::max(1.0, std::abs(start)));
}

INSTANTIATE_TEST_SUITE_P(Robots, ClosedLoop, testing::ValuesIn(loop_robots),
                         [](const testing::TestParamInfo<loop_robot>& robot) { return robot.param.name; });

TEST(ClosedLoops, Sr400HasTheDynamicsAndTheRankOfMujoco) {
    const std::string text = with_effects("sr400", "[]");
    constexpr int shoulder = 1;  // the axes of j2 and j7 are one
    loops_under_test robot(text, {shoulder}, 34);
    expect_dynamics_of_mujoco(robot, 10);
    expect_rank_of_mujoco(robot, {shoulder});
    EXPECT_FALSE(calls(robot.model.generated(), "sqrt("));
}

TEST(ClosedLoops, Sr400HasThePublishedCountsAsATreeAndFewerWhenClosed) {
    const temporary_folder folder;
    const auto count = [&folder](const std::string& text) {
        return generator::find_base(folder.write("sr400.yaml", text), templates_folder).parameters.size();
    };
    // 55 is what tools print that regroup by the rules of trees, with a rotor at each of the eight joints: the loop is
    // cut there and stays open. Closing it makes 13 more dependent: 8 that the two angles of the parallelogram tie to
    // those of the motors, 3 that a point mass at the cut leaves undecided, and the rotors of the passive joints.
    const std::string tree = with_effects("sr400", "[rotor_inertia]");
    const std::size_t loops = tree.find("loops:");
    EXPECT_EQ(count(tree.substr(0, loops) + tree.substr(tree.find("effects:"))), 55u);
    EXPECT_EQ(count(tree), 42u);
    EXPECT_EQ(count(with_effects("sr400", "[]")), 39u);
    EXPECT_EQ(generator::find_base(robot_file("sr400"), templates_folder).parameters.size(), 54u);
}

TEST(ClosedLoops, FiveBarOfTheFolderHasTheDynamicsAndTheRankOfMujoco) {
    // Lengths in metres for the margin from singular positions, which the robot's own are too short for.
    std::string text = with_effects("five_bar", "[]");
    text = replaced(text, "{a1: 0.063, a2: 0.075, a3: 0.075, a4: 0.063, a5: 0.025}",
                    "{a1: 0.63, a2: 0.75, a3: 0.75, a4: 0.63, a5: 0.25}");
    loops_under_test robot(text, {}, 35);
    expect_dynamics_of_mujoco(robot, 20);
    expect_rank_of_mujoco(robot, {});
}

TEST(ClosedLoops, FiveBarHasTheTorquesOfTheLagrangianOfCirclesThatIntersect) {
    loops_under_test robot(loop_robots[0].text, {}, 36);
    const Eigen::VectorXd chi = robot.model.regroup(robot.standard);
    const five_bar_lagrangian oracle(robot.links);
    for (int k = 0; k < 10; ++k) {
        const joint_state s = robot.state();
        // Differences of differences: 1e-16 / (1e-5 * 1e-4) of rounding, 1e-8 times higher derivatives.
        EXPECT_LE(deviation(robot.model.inverse_dynamics(s, chi), oracle.torque(s)), 1e-4);
    }
}

TEST(ClosedLoops, FrictionOfAPassiveJointActsThroughItsRates) {
    const std::string text =
        std::string(loop_robots[0].text) +
        "effects: [{effect: viscous_friction, joints: [j3]}, {effect: coulomb_friction, joints: "
        "[j4]},\n          {effect: rotor_inertia, joints: [j4]}, {effect: spring, joints: [j3]}]\n";
    loops_under_test robot(text, {}, 37);
    const Eigen::VectorXd chi =
        robot.model.regroup({{"Fv_j3", 0.3}, {"Fc_j4", 0.7}, {"Ia_j4", 0.2}, {"K_j3", 1.5}, {"K0_j3", -0.4}});
    for (int k = 0; k < 20; ++k) {
        const joint_state s = robot.state();
        const joint_state all = robot.oracle->motion(s);
        const Eigen::MatrixXd G = robot.oracle->rates(all.q);
        const double angle = std::remainder(all.q[2], 2.0 * M_PI);
        const Eigen::VectorXd tau = G.row(2).transpose() * (0.3 * all.qd[2] + 1.5 * angle - 0.4) +
                                    G.row(3).transpose() * (0.7 * (all.qd[3] > 0.0 ? 1.0 : -1.0) + 0.2 * all.qdd[3]);
        EXPECT_LE(deviation(robot.model.inverse_dynamics(s, chi), tau), against_mujoco);
        EXPECT_LE(deviation(robot.model.regressor(s) * chi, tau), against_mujoco);
        joint_state still = s;
        still.qdd.setZero();
        EXPECT_LE(deviation(robot.model.bias(still, chi), robot.model.inverse_dynamics(still, chi)),
                  loops_against_themselves);
    }
}

TEST(ClosedLoops, PassiveJointsHaveNoFrictionUnlessItIsDeclared) {
    const temporary_folder folder;
    const std::string text = std::string(loop_robots[0].text) + "effects: [rotor_inertia, viscous_friction]\n";
    const generator::base_report base = generator::find_base(folder.write("robot.yaml", text), templates_folder);
    for (const auto& parameter : base.parameters) {
        EXPECT_EQ(parameter.name.find("Fv_"), std::string::npos) << parameter.name;
        EXPECT_EQ(parameter.name.find("Ia_"), std::string::npos) << parameter.name;
    }
}

TEST(ClosedLoops, APositionWhereALoopDoesNotCloseHasNoValueAndIsTold) {
    loops_under_test robot(loop_robots[0].text, {}, 38);
    const c_library c(robot.file);
    const auto closure = [&c](const Eigen::VectorXd& q) {
        double closed = 0.0;
        c.function<void(const double*, double*)>("closure")(q.data(), &closed);
        return closed;
    };
    const Eigen::VectorXd chi = robot.model.regroup(robot.standard);
    // Both cranks end at one point, (0.169, 0.248), which bars of 0.51 and 0.45 m cannot join.
    joint_state s{Eigen::Vector2d(0.7735, 1.6961), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    EXPECT_EQ(robot.oracle->closed(s.q).size(), 0);
    EXPECT_LT(closure(s.q), 0.0);
    EXPECT_FALSE(robot.model.inverse_dynamics(s, chi).allFinite());
    int pivot = 0;
    robot.model.forward_dynamics(s, s.qdd, chi, pivot);
    EXPECT_GT(pivot, 0);
    for (int k = 0; k < 20; ++k) {
        s = robot.state();
        const Eigen::VectorXd all = robot.oracle->closed(s.q);
        // Between bars of 0.51 and 0.45 m, whose angle the positions of all joints give.
        const double angle = all[0] + 0.2 + all[2] + std::atan2(0.1, 0.5) - all[1] - all[3];
        EXPECT_NEAR(closure(s.q), std::pow(std::sin(angle), 2), 1e-12);
    }
}

}  // namespace

}  // namespace idim::test
