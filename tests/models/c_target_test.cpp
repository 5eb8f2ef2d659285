// The C99 code of a robot against its C++ code: printed from the same graph, so that both round alike, operation by
// operation, where both are compiled without contraction into fused operations.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>

#include "support/c_library.hpp"
#include "support/command.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

constexpr int compared_states = 20;

using motion_function = void(const double*, const double*, const double*, double*);
using inverse_function = void(const double*, const double*, const double*, const double*, double*);
using position_function = void(const double*, const double*, double*);
using bias_function = void(const double*, const double*, const double*, double*);
using forward_function = void(const double*, const double*, const double*, const double*, double*, double*);

/// Empty where the words say nothing and succeed.
std::string complaint(std::vector<std::string> words) {
    const command_result result = run_program(std::move(words));
    return result.status == 0 ? result.err : result.err + " (failed)";
}

struct two_targets {
    explicit two_targets(const std::string& file) : cpp(file), c(file) {}

    test_model cpp;
    c_library c;
};

class CTarget : public testing::TestWithParam<std::string> {
  protected:
    /// Generated and compiled once for all tests of a process.
    static const two_targets& robot() {
        static std::map<std::string, std::unique_ptr<two_targets>> known;
        auto& entry = known[GetParam()];
        if (!entry) {
            entry = std::make_unique<two_targets>(robot_file(GetParam()));
        }
        return *entry;
    }

    template <class F>
    static void at_random_states(const F& check) {
        std::mt19937_64 random(31);
        for (int k = 0; k < compared_states; ++k) {
            check(random_state(robot().cpp.dof(), random));
        }
    }

    /// Parameters of both signs: what is compared is rounding, whatever the robot.
    static Eigen::VectorXd parameters() { return Eigen::VectorXd::LinSpaced(robot().cpp.n_base(), -0.7, 1.9); }
};

TEST_P(CTarget, HasTheBitsOfTheCppTargetInDoublePrecision) {
    const c_library& c = robot().c;
    const idim_model_interface& cpp = robot().cpp.interface();
    const Eigen::VectorXd chi = parameters();
    const Eigen::Index n = robot().cpp.dof();
    const auto expect_same = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        EXPECT_TRUE(a == b) << "largest difference " << (a - b).cwiseAbs().maxCoeff();
    };
    at_random_states([&](const joint_state& s) {
        Eigen::VectorXd a(n * cpp.n_base), b(n * cpp.n_base);
        c.function<motion_function>("regressor")(s.q.data(), s.qd.data(), s.qdd.data(), a.data());
        cpp.regressor(s.q.data(), s.qd.data(), s.qdd.data(), 0.0, nullptr, b.data());
        expect_same(a, b);
        a = b = Eigen::VectorXd::Zero(n);
        c.function<inverse_function>("inverse_dynamics")(s.q.data(), s.qd.data(), s.qdd.data(), chi.data(), a.data());
        cpp.inverse_dynamics(s.q.data(), s.qd.data(), s.qdd.data(), 0.0, nullptr, chi.data(), b.data());
        expect_same(a, b);
        c.function<bias_function>("bias")(s.q.data(), s.qd.data(), chi.data(), a.data());
        cpp.bias(s.q.data(), s.qd.data(), 0.0, nullptr, chi.data(), b.data());
        expect_same(a, b);
        c.function<position_function>("gravity")(s.q.data(), chi.data(), a.data());
        cpp.gravity(s.q.data(), chi.data(), b.data());
        expect_same(a, b);
        Eigen::VectorXd pivots(n);
        c.function<forward_function>("forward_dynamics")(s.q.data(), s.qd.data(), s.qdd.data(), chi.data(), a.data(),
                                                         pivots.data());
        cpp.forward_dynamics(s.q.data(), s.qd.data(), s.qdd.data(), 0.0, nullptr, chi.data(), b.data());
        expect_same(a, b);
        a = b = Eigen::VectorXd::Zero(n * n);
        c.function<position_function>("mass_matrix")(s.q.data(), chi.data(), a.data());
        cpp.mass_matrix(s.q.data(), chi.data(), b.data());
        expect_same(a, b);
    });
    const Eigen::VectorXd standard = Eigen::VectorXd::LinSpaced(cpp.n_standard, -1.1, 2.3);
    Eigen::VectorXd a(cpp.n_base), b(cpp.n_base);
    c.function<void(const double*, double*)>("regroup")(standard.data(), a.data());
    cpp.regroup(standard.data(), b.data());
    expect_same(a, b);
}

TEST_P(CTarget, HasTheBitsOfTheCppTargetInSinglePrecision) {
    const auto c =
        robot().c.function<void(const float*, const float*, const float*, const float*, float*)>("inverse_dynamics_f");
    const Eigen::VectorXd chi = parameters();
    const Eigen::VectorXf parameters = chi.cast<float>();
    at_random_states([&](const joint_state& s) {
        const Eigen::VectorXf q = s.q.cast<float>(), qd = s.qd.cast<float>(), qdd = s.qdd.cast<float>();
        Eigen::VectorXf tau(q.size());
        c(q.data(), qd.data(), qdd.data(), parameters.data(), tau.data());
        EXPECT_EQ(tau, robot().cpp.inverse_dynamics_float(s, chi));
    });
}

TEST_P(CTarget, OneEvaluationOfTheSinesServesEveryModel) {
    const c_library& c = robot().c;
    if (!c.has("sines")) {
        GTEST_SKIP() << "no model of this robot reads a sine";
    }
    const Eigen::VectorXd chi = parameters();
    const Eigen::Index n = robot().cpp.dof();
    at_random_states([&](const joint_state& s) {
        Eigen::VectorXd sc(2 * n + 2), a(n), b(n);  // more than the sines of all angles
        c.function<void(const double*, double*)>("sines")(s.q.data(), sc.data());
        c.function<inverse_function>("inverse_dynamics")(s.q.data(), s.qd.data(), s.qdd.data(), chi.data(), a.data());
        c.function<void(const double*, const double*, const double*, const double*, const double*, double*)>(
            "inverse_dynamics_sc")(s.q.data(), sc.data(), s.qd.data(), s.qdd.data(), chi.data(), b.data());
        EXPECT_EQ(a, b);
        if (c.has("mass_matrix_sc")) {
            a = b = Eigen::VectorXd::Zero(n * n);
            c.function<position_function>("mass_matrix")(s.q.data(), chi.data(), a.data());
            c.function<bias_function>("mass_matrix_sc")(s.q.data(), sc.data(), chi.data(), b.data());
            EXPECT_EQ(a, b);
        }
    });
}

TEST_P(CTarget, CompilesWithoutAWarning) {
    // robot() compiled every file with the C compiler of this build; here is the other one, and the header as C++.
    const c_library& c = robot().c;
    std::vector<std::string> clang = {IDIM_CLANG, "-fsyntax-only"};
    clang.insert(clang.end(), strict_c_options().begin(), strict_c_options().end());
    for (const std::string& source : c.sources()) {
        clang.push_back(source);
    }
    EXPECT_EQ(complaint(clang), "");
    const std::string user = (c.folder() / "user.cpp").string();
    std::ofstream(user) << "#include \"" << c.generated().robot << ".h\"\n";
    EXPECT_EQ(complaint({IDIM_CXX_COMPILER, "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Werror",
                         "-Wold-style-cast", user}),
              "");
}

INSTANTIATE_TEST_SUITE_P(AllRobots, CTarget, testing::ValuesIn(robot_names()),
                         [](const testing::TestParamInfo<std::string>& robot) { return robot.param; });

TEST(CTargetOfEffects, EveryFunctionAnEffectMayCallHasTheBitsOfTheCppTarget) {
    const two_targets robot(effects_arm_file);
    const auto c =
        robot.c
            .function<void(const double*, const double*, const double*, double, const double*, const double*, double*)>(
                "inverse_dynamics");
    const Eigen::VectorXd chi = Eigen::VectorXd::LinSpaced(robot.cpp.n_base(), -0.7, 1.9);
    std::mt19937_64 random(32);
    for (int k = 0; k < compared_states; ++k) {
        const joint_state s = random_state(2, random);
        const Eigen::VectorXd temp = Eigen::Vector2d(20.0 + k, 30.5 - k);
        Eigen::VectorXd tau(2);
        c(s.q.data(), s.qd.data(), s.qdd.data(), 0.3 * k, temp.data(), chi.data(), tau.data());
        EXPECT_EQ(tau, robot.cpp.inverse_dynamics(s, chi, 0.3 * k, temp));
    }
}

}  // namespace

}  // namespace idim::test
