// A program that has the models of two robots compiled in through idim_generate, as a user's would.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "idim/estimate.hpp"
#include "idim/model_interface.h"
#include "rx90/model.hpp"
#include "scara/inverse_dynamics.hpp"
#include "scara/model.hpp"
#include "scara/regressor.hpp"

extern "C" const idim_model_interface* idim_model_scara(void);
extern "C" const idim_model_interface* idim_model_rx90(void);

namespace {

namespace scara = idim_models::scara;

TEST(BuiltInModel, TwoRobotsKeepTheirOwnNamesInOneProgram) {
    EXPECT_STREQ(idim_model_scara()->robot, "scara");
    EXPECT_STREQ(idim_model_rx90()->robot, "rx90");
    EXPECT_EQ(idim_model_rx90()->n_base, idim_models::rx90::base_parameters);
    EXPECT_STREQ(idim_model_scara()->parameter_names[0], "ZZ1R");
}

TEST(BuiltInModel, HeadersWorkInSinglePrecision) {
    const std::array<double, 2> q = {0.3, -1.2}, qd = {0.7, 0.2}, qdd = {-1.1, 2.0};
    const std::array<float, 2> qf = {0.3F, -1.2F}, qdf = {0.7F, 0.2F}, qddf = {-1.1F, 2.0F};
    std::array<double, 2 * scara::base_parameters> W{};
    std::array<float, 2 * scara::base_parameters> Wf{};
    scara::regressor(q.data(), qd.data(), qdd.data(), W.data());
    scara::regressor(qf.data(), qdf.data(), qddf.data(), Wf.data());
    for (std::size_t i = 0; i < W.size(); ++i) {
        EXPECT_NEAR(Wf[i], W[i], 1e-5) << i;  // a few roundings of numbers of order one at 6e-8 each
    }
}

TEST(BuiltInModel, IdentifiersTakeItAsItIs) {
    const idim_model_interface& model = *idim_model_scara();
    const Eigen::VectorXd truth =
        (Eigen::VectorXd(8) << 3.44, 0.03, 0.82, 0.062, 0.242, 0.014, 0.013, 0.137).finished();
    const double rate = 200.0;
    idim::filtered_samples samples;
    samples.file = "closed form";
    samples.rate = rate;
    const Eigen::Index count = 4000;
    samples.t = Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1) / rate);
    samples.q.resize(count, 2);
    samples.qd.resize(count, 2);
    samples.qdd.resize(count, 2);
    samples.tau.resize(count, 2);
    for (Eigen::Index k = 0; k < count; ++k) {
        for (int j = 0; j < 2; ++j) {
            const double w = 1.3 + j;
            samples.q(k, j) = std::sin(w * samples.t[k]) + 0.4 * std::sin(2.7 * w * samples.t[k]);
            samples.qd(k, j) = w * std::cos(w * samples.t[k]) + 1.08 * w * std::cos(2.7 * w * samples.t[k]);
            samples.qdd(k, j) = -w * w * std::sin(w * samples.t[k]) - 2.916 * w * w * std::sin(2.7 * w * samples.t[k]);
        }
        const Eigen::VectorXd q = samples.q.row(k), qd = samples.qd.row(k), qdd = samples.qdd.row(k);
        Eigen::VectorXd tau(2);
        model.inverse_dynamics(q.data(), qd.data(), qdd.data(), samples.t[k], nullptr, truth.data(), tau.data());
        samples.tau.row(k) = tau;
    }
    idim::filter_choice choice;
    choice.decimation = 1;
    const idim::estimate found = least_squares(observe(model, {samples}, choice), idim::least_squares_method::ols);
    ASSERT_EQ(found.chi.size(), 8) << found.message;
    EXPECT_LT((found.chi - truth).norm(), 1e-10);  // exact data: rounding times the condition number
}

}  // namespace
