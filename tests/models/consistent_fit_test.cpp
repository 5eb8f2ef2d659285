// Constrained weighted least squares on arms with gravity and friction, their links known.
#include "idim/consistent_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <random>

#include "idim/input_error.hpp"
#include "oracles/rigid_link.hpp"
#include "support/robot_files.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

physical_parameters known_of(const test_model& model) {
    const auto& list = model.generated().base.standard_parameters;
    physical_parameters known;
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (list[k].inertial == 0) {
            known.bodies.push_back({"link of " + list[k].joint, {}});
        }
        if (list[k].inertial >= 0) {
            known.bodies.back().places[static_cast<std::size_t>(list[k].inertial)] = static_cast<Eigen::Index>(k);
        } else if (list[k].min) {
            known.coefficients.push_back({static_cast<Eigen::Index>(k), *list[k].min});
        }
    }
    return known;
}

/// The Denso arm of [CWLS section III] with links that could exist.
class ConsistentFit : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { model_ = new test_model(robot_file("denso_vp6242g")); }
    static void TearDownTestSuite() {
        delete model_;
        model_ = nullptr;
    }

    ConsistentFit() : known_(known_of(*model_)) {
        std::mt19937_64 random(5);
        truth_values_ = standard_parameters_of(plausible_links(6, random));
        for (int j = 1; j <= 6; ++j) {
            truth_values_["Fv" + std::to_string(j)] = 6.0 / j;
            truth_values_["Fc" + std::to_string(j)] = 4.0 / j;
        }
        truth_ = model_->regroup(truth_values_);
    }

    /// Rows at 20 Hz along sums of five sinusoids a joint; `swing` scales the positions, `noise` is of the torque of
    /// every joint.
    observation rows(double swing, double noise, std::uint64_t seed, Eigen::Index samples = 600) const {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        observation result;
        result.dof = 6;
        result.n_base = static_cast<int>(model_->n_base());
        observation_block block;
        block.rate = 20.0;
        block.t = Eigen::ArrayXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) / block.rate);
        block.kept = all_rows(6, samples);
        block.W.assign(6, Eigen::MatrixXd(samples, result.n_base));
        block.Y.assign(6, Eigen::VectorXd(samples));
        for (Eigen::Index k = 0; k < samples; ++k) {
            joint_state state{Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
            for (int j = 0; j < 6; ++j) {
                for (int h = 1; h <= 5; ++h) {
                    const double w = 2.0 * std::numbers::pi * (0.05 + 0.11 * h + 0.013 * j);
                    const double phase = w * block.t[k] + 1.7 * h * (j + 1);
                    state.q[j] += swing * 0.5 * std::sin(phase);
                    state.qd[j] += swing * 0.5 * w * std::cos(phase);
                    state.qdd[j] -= swing * 0.5 * w * w * std::sin(phase);
                }
            }
            const Eigen::MatrixXd W = model_->regressor(state);
            const Eigen::VectorXd tau = W * truth_;
            for (std::size_t j = 0; j < 6; ++j) {
                block.W[j].row(k) = W.row(static_cast<Eigen::Index>(j));
                block.Y[j][k] = tau[static_cast<Eigen::Index>(j)] + noise * normal(random);
            }
        }
        result.blocks = {block};
        return result;
    }

    consistent_estimate fit(const observation& data, const consistency_request& request = {}) const {
        return consistent_fit(model_->interface(), data, known_, request);
    }

    /// Every body of the result meets its constraint, as eigenvalues of matrices written out here.
    void expect_consistent(const consistent_estimate& found, consistency_kind kind = consistency_kind::full) const {
        for (const inertial_body& body : known_.bodies) {
            const body_parameters p = body.of(found.standard);
            Eigen::Matrix3d I;
            I << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
            const Eigen::Vector3d c = p.segment<3>(6) / p[9];
            const Eigen::Matrix3d central =
                I - p[9] * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
            const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(central).eigenvalues();
            EXPECT_GT(p[9], 0.0) << body.name;
            EXPECT_GT(moments[0], 0.0) << body.name;
            if (kind == consistency_kind::full) {
                EXPECT_GT(moments[0] + moments[1], moments[2]) << body.name;
            }
        }
        for (const auto& coefficient : known_.coefficients) {
            EXPECT_GT(found.standard[coefficient.place], coefficient.low);
        }
        Eigen::VectorXd again(model_->n_base());
        model_->interface().regroup(found.standard.data(), again.data());
        EXPECT_LT(deviation(found.fit.chi, again), 1e-9);
        EXPECT_GT(found.inertia.smallest, 0.0);
        EXPECT_EQ(found.inertia.share_not_positive, 0.0);
        EXPECT_GE(found.inertia.configurations, 100000);
    }

    static test_model* model_;
    physical_parameters known_;
    value_table truth_values_;
    Eigen::VectorXd truth_;
};

test_model* ConsistentFit::model_ = nullptr;

TEST_F(ConsistentFit, ReturnsAConsistentTruthWithoutNoiseAndNoConstraintIsActive) {
    for (const auto kind : {consistency_kind::full, consistency_kind::spatial}) {
        for (const auto objective : {consistency_objective::weighted, consistency_objective::normal}) {
            consistency_request request;
            request.kind = kind;
            request.objective = objective;
            const consistent_estimate found = fit(rows(1.0, 0.0, 1), request);
            ASSERT_EQ(found.fit.chi.size(), truth_.size()) << found.fit.message;
            EXPECT_TRUE(found.fit.converged) << found.fit.message;
            // The proof ends at 1e-13 of the squares: 3e-7 of the torque, times the condition number (squared by
            // `normal`).
            EXPECT_LT(deviation(found.fit.chi, truth_), objective == consistency_objective::weighted ? 1e-5 : 1e-3);
            EXPECT_TRUE(found.active.empty()) << found.active.front().name;
            EXPECT_EQ(std::count(found.at_bound.begin(), found.at_bound.end(), true), 0);
            expect_consistent(found, kind);
        }
    }
}

TEST_F(ConsistentFit, WhereNothingIsActiveItIsWeightedLeastSquaresWithItsDeviations) {
    const consistent_estimate found = fit(rows(1.0, 0.05, 2));
    ASSERT_TRUE(found.fit.converged) << found.fit.message;
    ASSERT_TRUE(found.active.empty()) << found.active.front().name;
    const estimate wls = least_squares(rows(1.0, 0.05, 2), least_squares_method::wls);
    // A gap of 1e-8 of the objective leaves sqrt(2e-8) = 1.4e-4 of the residual's norm, sqrt(3600) deviations: below
    // 1e-2 of one.
    for (Eigen::Index k = 0; k < truth_.size(); ++k) {
        EXPECT_LT(std::abs(found.fit.chi[k] - wls.chi[k]), 1e-2 * wls.deviations()[k]);
        EXPECT_NEAR(found.fit.deviations()[k], wls.deviations()[k], 1e-3 * wls.deviations()[k]);
        EXPECT_LT(std::abs(found.fit.chi[k] - truth_[k]), 5.0 * found.fit.deviations()[k]);
    }
}

TEST_F(ConsistentFit, APoorlyExcitedLogLeavesTheInertiaMatrixIndefiniteWithoutConstraints) {
    const observation data = rows(0.35, 2.0, 3);
    const consistent_estimate found = fit(data);
    ASSERT_TRUE(found.fit.converged) << found.fit.message;
    EXPECT_LT(found.unconstrained_inertia.smallest, 0.0);
    EXPECT_GT(found.unconstrained_inertia.share_not_positive, 0.0);
    EXPECT_FALSE(found.active.empty());
    EXPECT_LE(found.gap, 1e-8 * found.objective);
    expect_consistent(found);
    // The truth is consistent: no better fit than the optimum, and the optimum nearer to it than least squares in the
    // metric of the rows.
    double at_truth = 0.0;
    const std::vector<double> weight = [&] {
        std::vector<double> w;
        for (const double d : least_squares(data, least_squares_method::ols).joint_deviation) {
            w.push_back(1.0 / d);
        }
        return w;
    }();
    double to_optimum = 0.0, to_wls = 0.0;
    for (std::size_t j = 0; j < 6; ++j) {
        const auto& block = data.blocks[0];
        at_truth += 0.5 * (weight[j] * (block.Y[j] - block.W[j] * truth_)).squaredNorm();
        to_optimum += (weight[j] * block.W[j] * (found.fit.chi - truth_)).squaredNorm();
        to_wls += (weight[j] * block.W[j] * (found.unconstrained.chi - truth_)).squaredNorm();
    }
    EXPECT_GE(at_truth, found.objective - found.gap);
    EXPECT_LT(to_optimum, to_wls) << "a projection on a convex set that holds the truth";
}

TEST_F(ConsistentFit, SpatialAllowsMoreThanFullAndBothLessThanNothing) {
    const observation data = rows(0.35, 2.0, 3);
    consistency_request spatial;
    spatial.kind = consistency_kind::spatial;
    const consistent_estimate loose = fit(data, spatial);
    const consistent_estimate tight = fit(data);
    ASSERT_TRUE(loose.fit.converged) << loose.fit.message;
    expect_consistent(loose, consistency_kind::spatial);
    EXPECT_GE(loose.objective, loose.unconstrained_objective);
    // Floors of the two differ by little against the objective.
    EXPECT_GE(tight.objective, loose.objective - loose.gap - 1e-3);
}

TEST_F(ConsistentFit, AFrictionAtItsBoundHasNoDeviation) {
    truth_values_["Fv6"] = 0.0;
    truth_values_["Fc6"] = 4.0;
    truth_ = model_->regroup(truth_values_);
    const std::vector<std::string> names = model_->parameter_names();
    const auto place = std::find(names.begin(), names.end(), "Fv6") - names.begin();
    int at_bound = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const consistent_estimate found = fit(rows(1.0, 0.3, seed, 300));
        ASSERT_TRUE(found.fit.converged) << found.fit.message;
        EXPECT_EQ(found.at_bound[static_cast<std::size_t>(place)], found.unconstrained.chi[place] < 0.0);
        EXPECT_GT(found.fit.chi[place], -1e-12);
        at_bound += found.at_bound[static_cast<std::size_t>(place)] ? 1 : 0;
    }
    // Half of the draws, give or take three deviations of a fair coin.
    EXPECT_GE(at_bound, 1);
    EXPECT_LE(at_bound, 9);
}

TEST_F(ConsistentFit, BoundsOfMassesTheirSumAndTheCentresHold) {
    consistency_request request;
    request.bodies.resize(6);
    for (body_bounds& bounds : request.bodies) {
        bounds.mass = {0.5, 4.0};
        bounds.centre = {interval{-0.2, 0.2}, interval{-0.2, 0.2}, interval{0.0, 0.05}};
    }
    request.total_mass = {10.0, 12.0};
    const consistent_estimate found = fit(rows(1.0, 0.5, 4), request);
    // Two dozen bounds that press against one another: rounding ends the proof early.
    EXPECT_LE(found.gap, 1e-5 * found.objective) << found.fit.message;
    expect_consistent(found);
    double total = 0.0;
    for (const consistent_body& body : found.bodies) {
        total += body.mass;
        EXPECT_GT(body.mass, 0.5);
        EXPECT_LT(body.mass, 4.0);
        EXPECT_LT(body.centre.head<2>().cwiseAbs().maxCoeff(), 0.2);
        EXPECT_GT(body.centre.z(), 0.0);
        EXPECT_LT(body.centre.z(), 0.05);
    }
    EXPECT_GT(total, 10.0);
    EXPECT_LT(total, 12.0);
    EXPECT_FALSE(found.active.empty());
}

TEST_F(ConsistentFit, ThePriorDecidesWhatTheDataLeavesOpen) {
    consistency_request request;
    const std::vector<std::string> names = model_->standard_names();
    request.prior = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
        (*request.prior)[static_cast<Eigen::Index>(k)] =
            truth_values_.count(names[k]) > 0 ? truth_values_.at(names[k]) : 0.0;
    }
    // But for the floor, by which the divergences are shifted: up to some percent of the smallest eigenvalues.
    // Without noise and with the truth as prior every link comes out whole, what no torque shows of it included.
    const consistent_estimate found = fit(rows(1.0, 0.0, 1), request);
    ASSERT_TRUE(found.fit.converged) << found.fit.message;
    for (const inertial_body& body : known_.bodies) {
        EXPECT_LT((body.of(found.standard) - body.of(*request.prior)).norm(), 1e-2 * body.of(*request.prior).norm())
            << body.name;
    }
    // The same base parameters as without a prior, other links.
    const observation noisy = rows(0.35, 2.0, 3);
    const consistent_estimate with = fit(noisy, request);
    const consistent_estimate without = fit(noisy);
    EXPECT_NEAR(with.objective, without.objective, 1e-5 * with.objective)
        << "sizes of bodies are limited near the prior";
    EXPECT_GT((with.standard - without.standard).norm(), 1e-2);
    request.prior_strength = 10.0;
    const consistent_estimate pulled = fit(noisy, request);
    ASSERT_TRUE(pulled.fit.converged) << pulled.fit.message;
    EXPECT_LT((pulled.fit.chi - truth_).norm(), (without.fit.chi - truth_).norm()) << "the prior is the truth";
}

TEST_F(ConsistentFit, ContradictoryBoundsAndPriorsAreNamed) {
    const observation data = rows(1.0, 0.1, 1, 300);
    const auto refusal = [&](const consistency_request& request) {
        try {
            fit(data, request);
        } catch (const input_error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    consistency_request request;
    request.total_mass = {1.0, 5.0};
    request.bodies.resize(6);
    request.bodies[1].mass = {4.0, 8.0};
    request.bodies[2].mass = {2.0, 8.0};
    EXPECT_EQ(refusal(request).substr(0, 49), "total mass: 1 to 5 kg, but the bounds of the mass") << refusal(request);
    request.total_mass = {};
    request.bodies[1].mass = {8.0, 4.0};
    EXPECT_NE(refusal(request).find("mass of the link of j2"), std::string::npos) << refusal(request);
    request.bodies[1].mass = {-4.0, -2.0};
    EXPECT_NE(refusal(request).find("mass of the link of j2"), std::string::npos) << refusal(request);
    request.bodies[1] = {};
    request.bodies[3].centre[2] = {0.1, 0.1};
    EXPECT_NE(refusal(request).find("centre of the link of j4 along z"), std::string::npos) << refusal(request);
    consistency_request prior;
    prior.prior = Eigen::VectorXd::Constant(model_->interface().n_standard, 1.0);
    EXPECT_NE(refusal(prior).find("link of j1 is not consistent"), std::string::npos) << refusal(prior);
}

}  // namespace

}  // namespace idim::test
