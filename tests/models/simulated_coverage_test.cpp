// The whole chain on data whose truth and noise are known: closed-loop simulation, filtering, weighted least squares,
// intervals.
#include <gtest/gtest.h>

#include <cmath>

#include "idim/estimate.hpp"
#include "idim/simulation.hpp"
#include "oracles/scara_loop.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

TEST(SimulatedCoverage, IntervalsOfTheWholeChainCoverTheTruthAtTheirRate) {
    constexpr int runs = 200;
    const test_model scara(robot_file("scara"));
    const idim_model_interface& model = scara.interface();
    // [IV table 1], LMX2 = 0.121 and LMY2 = 0.007 with L = 0.5 m.
    const Eigen::VectorXd truth =
        (Eigen::VectorXd(8) << 3.44, 0.03, 0.82, 0.062, 0.242, 0.014, 0.013, 0.137).finished();
    const Eigen::VectorXd wn = Eigen::Vector2d(1.0, 10.0);
    const pd_cascade law =
        tune_pd_cascade(200.0, wn, Eigen::Vector2d(1.0, 1.0), largest_inertia(model, truth), Eigen::Vector2d(1.0, 1.0));
    const log reference = scara_reference(60.0);
    Eigen::VectorXd covered = Eigen::VectorXd::Zero(8);
    for (int run = 0; run < runs; ++run) {
        // After the filter the torque noise is 3 % of the torque, as in the paper.
        const measurement_noise noise{Eigen::Vector2d(1e-4, 1e-4), Eigen::Vector2d(0.4, 0.08),
                                      static_cast<std::uint64_t>(run) + 1};
        const log measured = simulate(model, truth, law, reference, noise).measured;
        const filter_choice choice = choose_filter({measured}, {});
        const estimate found =
            least_squares(observe(model, {filter_log(measured, choice)}, choice), least_squares_method::wls);
        ASSERT_EQ(found.chi.size(), 8) << found.message;
        const Eigen::VectorXd std = found.deviations();
        for (int k = 0; k < 8; ++k) {
            covered[k] += std::abs(found.chi[k] - truth[k]) < 1.96 * std[k] ? 1.0 : 0.0;
        }
    }
    const Eigen::VectorXd percent = 100.0 * covered / runs;
    EXPECT_GE(percent.mean(), 92.0);
    EXPECT_LE(percent.mean(), 98.0);
    for (int k = 0; k < 8; ++k) {
        // Binomial deviation of 200 runs at 95 % is 1.5 %: four of them, and what the filter's bias of 0.1 % costs.
        EXPECT_GE(percent[k], 89.0) << model.parameter_names[k];
        RecordProperty(model.parameter_names[k], std::to_string(percent[k]));
    }
}

}  // namespace

}  // namespace idim::test
