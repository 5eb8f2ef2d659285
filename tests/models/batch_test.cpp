// The batch form against the functions of one sample, for every robot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

// More than two packs of eight lanes, and odd; rows of a larger array.
constexpr Eigen::Index batch_samples = 37;
constexpr Eigen::Index stride = 41;

/// Arrays of random motion with a stride, by columns.
struct sampled_motion {
    explicit sampled_motion(Eigen::Index joints)
        : q(stride, joints), qd(stride, joints), qdd(stride, joints), t(stride), temp(stride, joints) {
        std::mt19937_64 random(41);
        for (Eigen::Index k = 0; k < stride; ++k) {
            const joint_state s = random_state(joints, random);
            q.row(k) = s.q;
            qd.row(k) = s.qd;
            qdd.row(k) = s.qdd;
            t[k] = 0.3 * static_cast<double>(k);
            temp.row(k) = Eigen::RowVectorXd::LinSpaced(joints, 20.0, 40.0 + static_cast<double>(k));
        }
    }

    idim_samples part(Eigen::Index first, Eigen::Index count) const {
        return {static_cast<size_t>(count), static_cast<size_t>(stride), q.data() + first,
                qd.data() + first,          qdd.data() + first,          t.data() + first,
                temp.data() + first};
    }
    joint_state state(Eigen::Index k) const { return {q.row(k), qd.row(k), qdd.row(k)}; }

    Eigen::MatrixXd q, qd, qdd;
    Eigen::VectorXd t;
    Eigen::MatrixXd temp;
};

class Batch : public testing::TestWithParam<std::string> {
  protected:
    static const test_model& model() {
        static std::map<std::string, std::unique_ptr<test_model>> known;
        auto& entry = known[GetParam()];
        if (!entry) {
            entry =
                std::make_unique<test_model>(GetParam() == "effects_arm" ? effects_arm_file : robot_file(GetParam()));
        }
        return *entry;
    }
    static Eigen::VectorXd parameters() { return Eigen::VectorXd::LinSpaced(model().n_base(), -0.7, 1.9); }

    /// Regressors of samples first..first+count-1, one a row; NaN where nothing was written.
    static Eigen::MatrixXd regressors(const sampled_motion& all, Eigen::Index first, Eigen::Index count) {
        Eigen::MatrixXd W = Eigen::MatrixXd::Constant(count + 3, model().dof() * model().n_base(), std::nan(""));
        const idim_samples part = all.part(first, count);
        model().interface().regressor_batch(&part, W.data(), static_cast<size_t>(W.rows()));
        EXPECT_TRUE(W.bottomRows(3).array().isNaN().all()) << "written behind the last of " << count << " samples";
        return W.topRows(count);
    }
    static Eigen::MatrixXd torques(const sampled_motion& all, Eigen::Index first, Eigen::Index count) {
        Eigen::MatrixXd tau = Eigen::MatrixXd::Constant(count + 3, model().dof(), std::nan(""));
        const idim_samples part = all.part(first, count);
        const Eigen::VectorXd chi = parameters();
        model().interface().inverse_dynamics_batch(&part, chi.data(), tau.data(), static_cast<size_t>(tau.rows()));
        EXPECT_TRUE(tau.bottomRows(3).array().isNaN().all()) << "written behind the last of " << count << " samples";
        return tau.topRows(count);
    }
};

std::vector<std::string> robots_and_effects() {
    std::vector<std::string> names = open_robot_names();  // loops do not close at every state
    names.emplace_back("effects_arm");
    return names;
}

TEST_P(Batch, HasTheValuesOfOneSampleAtATime) {
    // Sines differ by two units in the last place (4e-16); some hundred operations carry that on, and terms cancel in
    // part.
    constexpr double tolerance = 1e-13;
    const sampled_motion all(model().dof());
    const Eigen::MatrixXd W = regressors(all, 0, batch_samples);
    const Eigen::MatrixXd tau = torques(all, 0, batch_samples);
    for (Eigen::Index k = 0; k < batch_samples; ++k) {
        const Eigen::VectorXd temp = all.temp.row(k);
        const Eigen::MatrixXd one = model().regressor(all.state(k), all.t[k], temp);
        const Eigen::MatrixXd row = W.row(k).reshaped(model().n_base(), model().dof()).transpose();
        EXPECT_LE(deviation(row, one), tolerance) << "sample " << k;
        const Eigen::VectorXd torque = model().inverse_dynamics(all.state(k), parameters(), all.t[k], temp);
        EXPECT_LE(deviation(tau.row(k).transpose(), torque), tolerance) << "sample " << k;
    }
}

TEST_P(Batch, ASampleDependsNeitherOnItsNeighboursNorOnItsPlace) {
    const sampled_motion all(model().dof());
    const Eigen::MatrixXd W = regressors(all, 0, batch_samples);
    const Eigen::MatrixXd tau = torques(all, 0, batch_samples);
    for (const Eigen::Index count : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17}) {
        for (const Eigen::Index first : {0, 1, 6}) {
            EXPECT_EQ(regressors(all, first, count), W.middleRows(first, count)) << count << " from " << first;
            EXPECT_EQ(torques(all, first, count), tau.middleRows(first, count)) << count << " from " << first;
        }
    }
}

TEST_P(Batch, NoSamplesAreNoWork) {
    const sampled_motion all(model().dof());
    EXPECT_EQ(regressors(all, 0, 0).size(), 0);
    EXPECT_EQ(torques(all, 0, 0).size(), 0);
}

INSTANTIATE_TEST_SUITE_P(AllRobots, Batch, testing::ValuesIn(robots_and_effects()),
                         [](const testing::TestParamInfo<std::string>& robot) { return robot.param; });

}  // namespace

}  // namespace idim::test
