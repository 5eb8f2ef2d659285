// Properties of the generated models, for every robot of robots/ without closed loops. Other formulas and other code
// give the expected values: Orocos KDL for the rigid links, closed forms for the effects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <memory>
#include <random>

#include "description/robot_description.hpp"
#include "oracles/effect_terms.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

constexpr int checked_states = 50;
// Some hundred operations on both sides, each with rounding 1e-16 of its terms, and the terms may cancel in part.
constexpr double against_kdl = 1e-10;
constexpr double against_itself = 1e-11;

bool is_inertial(const std::string& name) {
    return name.front() == 'X' || name.front() == 'Y' || name.front() == 'Z' || name.front() == 'M';
}

/// A model with plausible links and drives, and the same robot in KDL.
struct robot_under_test {
    explicit robot_under_test(const std::string& name)
        : model(robot_file(name)), table(mdh_table_of(generator::read_robot(robot_file(name)))) {
        std::mt19937_64 random(2024);
        links = plausible_links(static_cast<int>(table.rows.size()), random);
        oracle = std::make_unique<kdl_robot>(table, links);
        rigid = standard_parameters_of(links);
        all = rigid;
        for (const std::string& parameter : model.standard_names()) {
            if (!is_inertial(parameter)) {
                all[parameter] = std::uniform_real_distribution<double>(0.1, 3.0)(random);
            }
        }
        chi_rigid = model.regroup(rigid);
        chi = model.regroup(all);
    }

    /// Inertias of links and drives without friction and offsets: what conserves energy.
    value_table conservative() const {
        value_table values = all;
        for (auto& [name, value] : values) {
            value = is_inertial(name) || name.rfind("Ia", 0) == 0 ? value : 0.0;
        }
        return values;
    }

    /// M by KDL with the drives' inertias: effect torques per unit of acceleration.
    Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const {
        Eigen::MatrixXd M = oracle->mass_matrix(q);
        const Eigen::Index n = q.size();
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
        const Eigen::VectorXd still = effect_torque(all, {q, zero, zero});
        for (Eigen::Index j = 0; j < n; ++j) {
            M.col(j) += effect_torque(all, {q, zero, Eigen::VectorXd::Unit(n, j)}) - still;
        }
        return M;
    }

    test_model model;
    mdh_table table;
    std::vector<rigid_link> links;
    std::unique_ptr<kdl_robot> oracle;
    value_table rigid, all;
    Eigen::VectorXd chi_rigid, chi;
};

class ModelOf : public testing::TestWithParam<std::string> {
  protected:
    /// Generated and compiled once for all tests of a process.
    static const robot_under_test& robot() {
        static std::map<std::string, std::unique_ptr<robot_under_test>> known;
        auto& entry = known[GetParam()];
        if (!entry) {
            entry = std::make_unique<robot_under_test>(GetParam());
        }
        return *entry;
    }

    /// The same states for every test: checks `deviation_at` of each and records the largest.
    template <class F>
    void expect_small(double tolerance, const F& deviation_at) {
        std::mt19937_64 random(7);
        double largest = 0.0;
        for (int k = 0; k < checked_states; ++k) {
            const double found = deviation_at(random_state(robot().model.dof(), random));
            ASSERT_LE(found, tolerance) << "state " << k;
            largest = std::max(largest, found);
        }
        RecordProperty("largest_deviation", fmt::format("{:.1e}", largest));
    }
};

/// Energy change along a passive motion by the classical Runge-Kutta method of order 4, relative to the largest kinetic
/// energy.
double energy_drift(const robot_under_test& robot, joint_state state, double step, int steps) {
    const Eigen::VectorXd chi = robot.model.regroup(robot.conservative());
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(robot.model.dof());
    double kinetic = 0.0;
    const auto energy = [&](const joint_state& s) {
        const double moving = 0.5 * s.qd.dot(robot.model.mass_matrix(s.q, chi) * s.qd);
        kinetic = std::max(kinetic, moving);
        return moving + robot.oracle->potential_energy(s.q);
    };
    const auto slope = [&](const joint_state& s, const joint_state& k, double h) {
        const joint_state at{s.q + h * k.q, s.qd + h * k.qd, {}};
        int pivot = -1;
        const Eigen::VectorXd qdd = robot.model.forward_dynamics(at, none, chi, pivot);
        EXPECT_EQ(pivot, 0);
        return joint_state{at.qd, qdd, {}};
    };
    const double start = energy(state);
    double drift = 0.0;
    for (int i = 0; i < steps; ++i) {
        const joint_state a = slope(state, {none, none, {}}, 0.0);
        const joint_state b = slope(state, a, 0.5 * step);
        const joint_state c = slope(state, b, 0.5 * step);
        const joint_state d = slope(state, c, step);
        state.q += step / 6.0 * (a.q + 2.0 * b.q + 2.0 * c.q + d.q);
        state.qd += step / 6.0 * (a.qd + 2.0 * b.qd + 2.0 * c.qd + d.qd);
        drift = std::max(drift, std::abs(energy(state) - start));
    }
    return drift / kinetic;
}

TEST_P(ModelOf, InverseDynamicsOfRigidLinksIsThatOfKdl) {
    expect_small(against_kdl, [](const joint_state& s) {
        return deviation(robot().model.inverse_dynamics(s, robot().chi_rigid), robot().oracle->inverse_dynamics(s));
    });
}

TEST_P(ModelOf, InverseDynamicsWithDrivesIsThatOfKdlPlusTheClosedFormOfTheEffects) {
    expect_small(against_kdl, [](const joint_state& s) {
        const Eigen::VectorXd expected = robot().oracle->inverse_dynamics(s) + effect_torque(robot().all, s);
        return deviation(robot().model.inverse_dynamics(s, robot().chi), expected);
    });
}

TEST_P(ModelOf, MassMatrixIsThatOfKdlPlusTheInertiaOfTheDrives) {
    expect_small(against_kdl, [](const joint_state& s) {
        const double rigid =
            deviation(robot().model.mass_matrix(s.q, robot().chi_rigid), robot().oracle->mass_matrix(s.q));
        return std::max(rigid, deviation(robot().model.mass_matrix(s.q, robot().chi), robot().mass_matrix(s.q)));
    });
}

TEST_P(ModelOf, MassMatrixIsSymmetricAndPositiveDefiniteForPlausibleLinks) {
    std::mt19937_64 random(8);
    for (int k = 0; k < checked_states; ++k) {
        const joint_state s = random_state(robot().model.dof(), random);
        for (const Eigen::VectorXd& chi : {robot().chi_rigid, robot().chi}) {
            const Eigen::MatrixXd M = robot().model.mass_matrix(s.q, chi);
            EXPECT_EQ(M, M.transpose());  // one value written twice: no rounding between them
            EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff(), 0.0);
        }
    }
}

TEST_P(ModelOf, GravityIsThatOfKdlWhateverTheDrives) {
    expect_small(against_kdl, [](const joint_state& s) {
        return deviation(robot().model.gravity(s.q, robot().chi), robot().oracle->gravity(s.q));
    });
}

TEST_P(ModelOf, BiasIsTheTorqueAtZeroAcceleration) {
    expect_small(against_itself, [](joint_state s) {
        const Eigen::VectorXd N = robot().model.bias(s, robot().chi);
        s.qdd.setZero();
        return deviation(N, robot().model.inverse_dynamics(s, robot().chi));
    });
}

TEST_P(ModelOf, RegressorTimesParametersIsTheInverseDynamics) {
    expect_small(against_itself, [](const joint_state& s) {
        const Eigen::VectorXd tau = robot().model.regressor(s) * robot().chi;
        return deviation(tau, robot().model.inverse_dynamics(s, robot().chi));
    });
}

TEST_P(ModelOf, ForwardDynamicsUndoesInverseDynamics) {
    // M has condition numbers of some thousands for these links: three to four digits more than rounding are lost.
    expect_small(against_kdl, [](const joint_state& s) {
        int pivot = -1;
        const Eigen::VectorXd tau = robot().model.inverse_dynamics(s, robot().chi);
        const Eigen::VectorXd qdd = robot().model.forward_dynamics(s, tau, robot().chi, pivot);
        EXPECT_EQ(pivot, 0);
        return deviation(qdd, s.qdd);
    });
}

TEST_P(ModelOf, ForwardDynamicsSolvesTheEquationsOfKdl) {
    expect_small(against_kdl, [](joint_state s) {
        const Eigen::VectorXd tau = 20.0 * s.qdd;
        int pivot = -1;
        const Eigen::VectorXd qdd = robot().model.forward_dynamics(s, tau, robot().chi, pivot);
        s.qdd.setZero();
        const Eigen::VectorXd N = robot().oracle->inverse_dynamics(s) + effect_torque(robot().all, s);
        const Eigen::VectorXd expected = robot().mass_matrix(s.q).llt().solve(tau - N);
        return deviation(qdd, expected);
    });
}

TEST_P(ModelOf, ForwardDynamicsNamesAJointWhereTheMassMatrixIsNotPositive) {
    std::mt19937_64 random(9);
    const joint_state s = random_state(robot().model.dof(), random);
    int pivot = 0;
    robot().model.forward_dynamics(s, s.qdd, -robot().chi, pivot);
    EXPECT_GE(pivot, 1);
    EXPECT_LE(pivot, robot().model.dof());
}

TEST_P(ModelOf, PassiveMotionKeepsItsEnergyToTheOrderOfTheIntegrator) {
    std::mt19937_64 random(10);
    const joint_state start = random_state(robot().model.dof(), random);
    const double coarse = energy_drift(robot(), start, 2e-3, 100);
    const double fine = energy_drift(robot(), start, 1e-3, 200);
    RecordProperty("energy_drift", fmt::format("{:.1e} {:.1e}", coarse, fine));
    EXPECT_LT(fine, 1e-6);
    // Order four: half the step, a sixteenth of the error, until rounding of some hundred steps shows.
    EXPECT_LT(fine, std::max(coarse / 10.0, 1e-12));
}

TEST_P(ModelOf, PrintedRegroupingsHaveTheValuesOfTheGeneratedRegroup) {
    value_table values = robot().all;
    for (const auto& [name, value] : robot().table.constants) {
        values[name] = value;
    }
    const auto& parameters = robot().model.generated().base.parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double printed = text_value(parameters[k].regroups, values);
        const double computed = robot().chi[static_cast<Eigen::Index>(k)];
        EXPECT_NEAR(computed, printed, 1e-13 * std::max(1.0, std::abs(printed))) << parameters[k].regroups;
    }
}

TEST_P(ModelOf, SinglePrecisionAgreesToItsRounding) {
    // 6e-8 a rounding, some hundred of them, and terms that cancel to a tenth.
    expect_small(1e-4, [](const joint_state& s) {
        const Eigen::VectorXd tau = robot().model.inverse_dynamics_float(s, robot().chi).cast<double>();
        return deviation(tau, robot().model.inverse_dynamics(s, robot().chi));
    });
}

INSTANTIATE_TEST_SUITE_P(AllRobots, ModelOf, testing::ValuesIn(open_robot_names()),
                         [](const testing::TestParamInfo<std::string>& robot) { return robot.param; });

}  // namespace

}  // namespace idim::test
