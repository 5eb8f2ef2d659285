// Derivatives of the inverse dynamics, here in C99, against differences of the torques that Orocos KDL and closed forms
// of the effects give.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "oracles/effect_terms.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/c_library.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

using derivatives_function = void(const double*, const double*, const double*, const double*, double*, double*);

class DerivativesOf : public testing::TestWithParam<std::string> {
  protected:
    DerivativesOf() {
        std::mt19937_64 random(2025);
        const mdh_table table = mdh_table_of(generator::read_robot(robot_file(GetParam())));
        const std::vector<rigid_link> links = plausible_links(static_cast<int>(table.rows.size()), random);
        oracle_ = std::make_unique<kdl_robot>(table, links);
        all_ = standard_parameters_of(links);
        for (const std::string& name : model_.standard_names()) {
            all_.try_emplace(name, std::uniform_real_distribution<double>(0.1, 3.0)(random));
        }
    }

    Eigen::VectorXd torque(const joint_state& state) const {
        return oracle_->inverse_dynamics(state) + effect_torque(all_, state);
    }

    /// Differences of fourth order by the positions or velocities.
    Eigen::MatrixXd differences(const joint_state& at, Eigen::VectorXd joint_state::*moved) const {
        const double h = 1e-3;
        Eigen::MatrixXd result(at.q.size(), at.q.size());
        for (Eigen::Index j = 0; j < at.q.size(); ++j) {
            const auto shifted = [&](double step) {
                joint_state state = at;
                (state.*moved)[j] += step;
                return torque(state);
            };
            result.col(j) = (8.0 * (shifted(h) - shifted(-h)) - (shifted(2.0 * h) - shifted(-2.0 * h))) / (12.0 * h);
        }
        return result;
    }

    test_model model_{robot_file(GetParam())};
    c_library code_{robot_file(GetParam()), true};
    std::unique_ptr<kdl_robot> oracle_;
    value_table all_;
};

TEST_P(DerivativesOf, AreDifferencesOfTheTorquesOfKdl) {
    const Eigen::VectorXd chi = model_.regroup(all_);
    const Eigen::Index n = model_.dof();
    std::mt19937_64 random(17);
    for (int k = 0; k < 20; ++k) {
        joint_state s = random_state(n, random);
        // Away from the jumps of sign(qd), so that no difference reaches across one.
        s.qd = s.qd.unaryExpr([](double v) { return v + (v < 0.0 ? -0.01 : 0.01); });
        row_major by_q(n, n), by_qd(n, n);
        code_.function<derivatives_function>("inverse_dynamics_derivatives")(s.q.data(), s.qd.data(), s.qdd.data(),
                                                                             chi.data(), by_q.data(), by_qd.data());
        // Error of the differences: h^4 = 1e-12 times the fifth derivative, and rounding of 1e-16 / h.
        EXPECT_LE(deviation(by_q, differences(s, &joint_state::q)), 1e-8);
        EXPECT_LE(deviation(by_qd, differences(s, &joint_state::qd)), 1e-8);
    }
}

INSTANTIATE_TEST_SUITE_P(Robots, DerivativesOf,
                         testing::Values("scara", "emps", "stanford", "rx90", "ur5", "panda", "tiago"),
                         [](const auto& test) { return test.param; });

}  // namespace

}  // namespace idim::test
