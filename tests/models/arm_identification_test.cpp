// Arms with gravity, simulated by MuJoCo: the instrumental variable finds the parameters that it was built from.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <random>

#include "description/robot_description.hpp"
#include "oracles/mdh_row.hpp"
#include "oracles/mujoco_arm.hpp"
#include "oracles/rigid_link.hpp"
#include "support/loop_experiments.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"
#include "support/urdf_text.hpp"

namespace idim::test {

namespace {

class ArmIdentification : public ::testing::TestWithParam<std::string> {};

TEST_P(ArmIdentification, InstrumentalVariableFindsWellExcitedParameters) {
    const temporary_folder folder;
    const std::string file = write_variant(folder, GetParam(), "[rotor_inertia, viscous_friction, coulomb_friction]");
    const test_model model(file);
    const mdh_table table = mdh_table_of(generator::read_robot(file));
    const auto n = static_cast<Eigen::Index>(table.rows.size());
    std::mt19937_64 random(11);
    const std::vector<rigid_link> links = plausible_links(static_cast<int>(n), random);
    std::vector<std::string> joints;
    value_table standard = standard_parameters_of(links);
    Eigen::VectorXd rotor(n), viscous(n), coulomb(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const std::string number = std::to_string(j + 1);
        joints.push_back("j" + number);
        standard["Ia" + number] = rotor[j] = 0.5 / static_cast<double>(j + 1);
        standard["Fv" + number] = viscous[j] = 3.0 / static_cast<double>(j + 1);
        standard["Fc" + number] = coulomb[j] = 4.0 / static_cast<double>(j + 1);
    }
    const Eigen::VectorXd truth = model.regroup(standard);
    const Eigen::VectorXd wn = Eigen::VectorXd::Constant(n, 25.0);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
    const pd_cascade law = tune_pd_cascade(1000.0, wn, ones, largest_inertia(model.interface(), truth), ones);
    const mujoco_arm arm{mujoco_robot(urdf_of(table, links), joints),
                         rotor,
                         viscous,
                         coulomb,
                         1000.0,
                         law.kp,
                         law.kv,
                         1e-5,
                         4.0 * ones};  // what drives of such arms leave, some 0.5 % of the torque
    const std::vector<log> logs = {arm.record(arm_reference(Eigen::VectorXd::Zero(n), 1.0, 40.0, 5), 7)};
    const filter_choice filter = choose_filter(logs, {});
    const loop_experiment experiment{model.interface(), logs, filter};
    const closed_loop loop = cascade_loop(model.interface(), 1000.0, wn);
    const observation rows = observe_steady(experiment, loop);
    const estimate ls = least_squares(rows, least_squares_method::wls);
    ASSERT_GT(ls.chi.size(), 0) << ls.message;
    const estimate fit =
        identify_in_loop(experiment, loop, rows, loop_method::iv, regular_start(model.interface())).fit;
    ASSERT_TRUE(fit.converged) << fit.message;
    EXPECT_LE(fit.iterations.size() - 1, 5U);
    int judged = 0;
    for (Eigen::Index k = 0; k < truth.size(); ++k) {
        const double std = fit.deviations()[k];
        if (std > 0.1 * std::abs(truth[k])) {
            continue;
        }
        ++judged;
        EXPECT_LT(std::abs(fit.chi[k] - truth[k]), 3.0 * std)
            << model.interface().parameter_names[k] << " " << fit.chi[k] << " for " << truth[k];
    }
    RecordProperty("well_excited", judged);
    EXPECT_GT(judged, static_cast<int>(truth.size()) / 2) << fit.message;
}

INSTANTIATE_TEST_SUITE_P(SixAndSevenJoints, ArmIdentification, ::testing::Values("denso_vp6242g", "tx40", "kuka_lwr"),
                         [](const auto& robot) { return robot.param; });

}  // namespace

}  // namespace idim::test
