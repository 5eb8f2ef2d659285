// Exciting motions: the published figures, derivatives against finite differences, and motions that keep their limits.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <set>

#include "excitation/excitation_problem.hpp"
#include "idim/excitation_quality.hpp"
#include "idim/excitation_search.hpp"
#include "idim/multisine.hpp"
#include "uniform_numbers.hpp"

namespace idim {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double degree = std::numbers::pi / 180.0;

/// Ranges and speeds of table II of the published experiment (Denso VP-6242G).
motion_limits published_limits() {
    motion_limits limits;
    limits.lower = degree * Eigen::Vector<double, 6>(-135, -45, -90, -155, -90, -160);
    limits.upper = degree * Eigen::Vector<double, 6>(135, 90, -40, 155, 90, 160);
    limits.velocity = degree * Eigen::Vector<double, 6>(168.79, 126.42, 168.31, 202.11, 205.13, 203.64);
    limits.acceleration = Eigen::VectorXd::Constant(6, infinite);
    limits.torque = limits.acceleration;
    return limits;
}

TEST(Multisine, HasThePublishedLimitFrequencies) {
    const Eigen::Vector<double, 6> published(.1989, .2981, 1.0715, .2075, .3627, .2025);
    // Four decimals are printed; of the speeds two, which makes up to 3e-5 Hz.
    EXPECT_LT((limit_frequencies(published_limits()) - published).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Multisine, IsThePublishedSumOfSinusoidsInItsRanges) {
    const motion_limits limits = published_limits();
    const fourier_series series = make_multisine(limits, {380.0, 55, 3});
    const motion_samples motion = sample_period(series, 38000);
    for (Eigen::Index j = 0; j < 6; ++j) {
        const auto& terms = series.joints[static_cast<std::size_t>(j)];
        ASSERT_EQ(terms.size(), 55U);
        std::set<int> multiples;
        for (const harmonic& term : terms) {
            multiples.insert(term.multiple);
            EXPECT_LE(term.multiple / 380.0, limit_frequencies(limits)[j]);
            EXPECT_NEAR(std::hypot(term.sine, term.cosine), std::hypot(terms[0].sine, terms[0].cosine), 1e-12);
        }
        EXPECT_EQ(multiples.size(), 55U);
        // The range is used up to 3e-5 and never left; these instants see the peaks to 1e-3 at least.
        const double largest = (motion.q.col(j).array() - limits.centre()[j]).abs().maxCoeff();
        EXPECT_NEAR(largest, limits.half_range()[j], 1e-3);
        EXPECT_LE(largest, limits.half_range()[j]);
        EXPECT_LT(motion.qd.col(j).cwiseAbs().maxCoeff(), limits.velocity[j]);
    }
    const fourier_series other = make_multisine(limits, {380.0, 55, 4});
    EXPECT_NE(other.joints[0][0].sine, series.joints[0][0].sine);
}

TEST(ExcitationPlan, OfThePublishedExperimentTakes4578Seconds) {
    excitation_plan plan{make_multisine(published_limits(), {380.0, 55, 1}), published_limits().centre()};
    plan.periods = 12;
    plan.rest_time = 4.0;
    plan.connection_time = 5.0;
    plan.rate = 100.0;
    EXPECT_DOUBLE_EQ(plan.duration(), 4578.0);
    const log reference = reference_of(plan, true);
    ASSERT_EQ(reference.samples(), 457801);
    EXPECT_DOUBLE_EQ(reference.duration(), 4578.0);
    // 4 s at rest at both ends, then the connection leaves it.
    for (const Eigen::Index k : {0, 400, 457400, 457800}) {
        EXPECT_LT((reference.qr.row(k).transpose() - plan.rest).norm(), 1e-12);
        EXPECT_LT(reference.qd.row(k).norm() + reference.qdd.row(k).norm(), 1e-10);
    }
    EXPECT_GT((reference.qr.row(650).transpose() - plan.rest).norm(), 1e-3);
    // Every period is the same.
    EXPECT_EQ(reference.qr.middleRows(900, 38000), reference.qr.middleRows(900 + 11 * 38000, 38000));
    // Positions, speeds and accelerations belong together and do not jump, through all parts: the trapezoidal rule
    // over a step h is off by h^3 / 12 of the third derivative, at most A (2 pi f)^3, 133 rad/s^3 for joint 3.
    const Eigen::Index steps = reference.samples() - 1;
    const Eigen::MatrixXd moved = reference.qr.bottomRows(steps) - reference.qr.topRows(steps);
    const Eigen::MatrixXd mean = 0.5 * (reference.qd.bottomRows(steps) + reference.qd.topRows(steps));
    EXPECT_LT((moved - 0.01 * mean).cwiseAbs().maxCoeff(), 1.2e-5);
}

/// Two joints with coupled, smooth columns and jumps of friction: gravity, coupled inertia, viscous, Coulomb friction.
void regressor(const double* q, const double* qd, const double* qdd, double, const double*, double* W) {
    Eigen::Map<Eigen::Matrix<double, 2, 5, Eigen::RowMajor>> out(W);
    out << qdd[0], std::cos(q[0] + q[1]), qdd[0] * std::cos(q[1]) + qd[1] * qd[1] * std::sin(q[1]), qd[0],
        static_cast<double>(qd[0] > 0) - static_cast<double>(qd[0] < 0),  //
        0.0, std::cos(q[0] + q[1]), qdd[1] + qd[0] * qd[0] * std::sin(q[1]), 0.5 * qd[1], std::sin(q[1]);
}

void arm_inverse_dynamics(const double* q, const double* qd, const double* qdd, double t, const double* temp,
                          const double* chi, double* tau) {
    Eigen::Matrix<double, 2, 5, Eigen::RowMajor> W;
    regressor(q, qd, qdd, t, temp, W.data());
    Eigen::Map<Eigen::Vector2d>(tau, 2) = W * Eigen::Map<const Eigen::Vector<double, 5>>(chi);
}

const char* const arm_joint_names[] = {"j1", "j2"};

idim_model_interface arm() {
    idim_model_interface model{};
    model.robot = "arm";
    model.dof = 2;
    model.n_base = 5;
    model.joint_names = arm_joint_names;
    model.regressor = regressor;
    model.inverse_dynamics = arm_inverse_dynamics;
    return model;
}

/// Planar links of 1 m and 0.5 m about parallel axes.
std::vector<link_row> planar_links() {
    link_row first;
    first.rate = Eigen::Vector2d(1.0, 0.0);
    link_row second;
    second.parent = 0;
    second.d = 1.0;
    second.rate = Eigen::Vector2d(0.0, 1.0);
    return {first, second};
}

limited_robot limited_arm(const idim_model_interface& model) {
    motion_limits limits;
    limits.lower = Eigen::Vector2d(-1.0, -1.5);
    limits.upper = Eigen::Vector2d(2.0, 1.5);
    limits.velocity = Eigen::Vector2d(2.0, 3.0);
    limits.acceleration = Eigen::Vector2d(4.0, infinite);
    limits.torque = Eigen::Vector2d(40.0, 20.0);
    limits.boxes = {{"box", 1, {0.5, 0.0, 0.0}, {-0.5, -1.2, -0.1}, {1.6, 1.45, 0.1}}};
    return {model, limits, Eigen::Vector<double, 5>(2.0, 3.0, 1.0, 0.5, 0.2), planar_links()};
}

TEST(PointOfLink, IsThatOfTwoPlanarLinks) {
    const Eigen::Vector2d q(0.3, -1.1);
    Eigen::Matrix3Xd jacobian;
    const Eigen::Vector3d place = point_of_link(planar_links(), 1, {0.5, 0.0, 0.2}, q, &jacobian);
    const double far = q[0] + q[1];
    EXPECT_LT((place - Eigen::Vector3d(std::cos(q[0]) + 0.5 * std::cos(far), std::sin(q[0]) + 0.5 * std::sin(far), 0.2))
                  .norm(),
              1e-15);
    Eigen::Matrix<double, 3, 2> expected;
    expected << -std::sin(q[0]) - 0.5 * std::sin(far), -0.5 * std::sin(far),  //
        std::cos(q[0]) + 0.5 * std::cos(far), 0.5 * std::cos(far), 0.0, 0.0;
    EXPECT_LT((jacobian - expected).norm(), 1e-15);
}

TEST(GramCriterion, TendsToTheConditionNumberWhateverTheScales) {
    Eigen::Matrix3d S;
    S << 1.0, 0.8, 0.0, 0.8, 1.0, 0.3, 0.0, 0.3, 1.0;
    const Eigen::DiagonalMatrix<double, 3> scale(100.0, 1.0, 1e-3);
    const double spread = std::sqrt(0.73);  // eigenvalues 1 and 1 +- sqrt(0.8^2 + 0.3^2)
    const gram_value value = criterion_of(scale * S * scale, excitation_criterion::condition, 60.0);
    EXPECT_NEAR(value.figure, std::sqrt((1.0 + spread) / (1.0 - spread)), 1e-9);
    // Powers of 60 leave only the extreme eigenvalues.
    EXPECT_NEAR(value.value, std::log(value.figure), 1e-9);
}

TEST(ExcitationProblem, DerivativesAreThoseOfFiniteDifferences) {
    const idim_model_interface model = arm();
    const limited_robot robot = limited_arm(model);
    for (const excitation_criterion criterion :
         {excitation_criterion::condition, excitation_criterion::unscaled_condition,
          excitation_criterion::information}) {
        search_options options;
        options.harmonics = 3;
        options.criterion = criterion;
        const excitation_problem problem(robot, 5.0, options);
        ASSERT_EQ(problem.constraints(), 2 + 2 + 1 + 2 + 1);
        const Eigen::VectorXd u = 0.5 * uniform_numbers(5).vector(problem.variables());
        const smoothing form{4.0, 30.0};
        const problem_value at = problem.evaluate(u, form);
        for (Eigen::Index k = 0; k < u.size(); ++k) {
            // Small enough that no sample's speed changes its sign.
            constexpr double step = 1e-7;
            const Eigen::VectorXd along = step * Eigen::VectorXd::Unit(u.size(), k);
            const problem_value up = problem.evaluate(u + along, form);
            const problem_value down = problem.evaluate(u - along, form);
            // Rounding of a value of order 1 over 1e-7.
            EXPECT_NEAR(at.gradient[k], (up.objective - down.objective) / (2.0 * step), 1e-5) << k;
            for (Eigen::Index c = 0; c < at.constraints.size(); ++c) {
                EXPECT_NEAR(at.jacobian(k, c), (up.constraints[c] - down.constraints[c]) / (2.0 * step), 1e-5)
                    << k << " " << c;
            }
        }
    }
}

excitation_plan arm_form(const limited_robot& robot) {
    excitation_plan form;
    form.series.period = 10.0;
    form.rest = choose_rest(robot, 1).q;
    form.periods = 2;
    form.rest_time = 1.0;
    form.connection_time = 4.0;
    form.rate = 100.0;
    return form;
}

TEST(ExcitationSearch, KeepsEveryLimitAndGivesTheSameAgain) {
    const idim_model_interface model = arm();
    const limited_robot robot = limited_arm(model);
    search_options options;
    options.harmonics = 4;
    options.starts = 2;
    options.evaluations = 60;
    options.seconds = 1e6;
    const search_result result = search_excitation(robot, arm_form(robot), options);
    ASSERT_TRUE(result.found);
    const log reference = reference_of(result.plan, true);
    for (Eigen::Index k = 0; k < reference.samples(); ++k) {
        const Eigen::Vector2d q = reference.qr.row(k);
        const Eigen::Vector2d qd = reference.qd.row(k);
        const Eigen::Vector2d qdd = reference.qdd.row(k);
        Eigen::Vector2d tau;
        arm_inverse_dynamics(q.data(), qd.data(), qdd.data(), 0.0, nullptr, robot.chi.data(), tau.data());
        const double x = std::cos(q[0]) + 0.5 * std::cos(q[0] + q[1]);
        const double y = std::sin(q[0]) + 0.5 * std::sin(q[0] + q[1]);
        ASSERT_TRUE((q.array() >= robot.limits.lower.array()).all() && (q.array() <= robot.limits.upper.array()).all());
        ASSERT_TRUE((qd.array().abs() <= robot.limits.velocity.array()).all()) << qd.transpose();
        ASSERT_LE(std::abs(qdd[0]), 4.0);
        ASSERT_TRUE((tau.array().abs() <= robot.limits.torque.array()).all()) << tau.transpose();
        ASSERT_TRUE(x >= -0.5 && x <= 1.6 && y >= -1.2 && y <= 1.45) << x << " " << y;
    }
    const search_result again = search_excitation(robot, arm_form(robot), options);
    EXPECT_EQ(reference.qr, reference_of(again.plan, false).qr);
    // A random motion within the same limits is what the search began with.
    const excitation_problem problem(robot, 10.0, options);
    const Eigen::VectorXd first =
        problem.start(arm_form(robot).rest, uniform_numbers(options.seed).vector(problem.variables()));
    EXPECT_LT(judge_excitation(model, result.plan.series).scaled_condition_number,
              0.8 * judge_excitation(model, problem.series(first)).scaled_condition_number);
}

TEST(ExcitationSearch, GivesTheBestSoFarWhereItIsStopped) {
    const idim_model_interface model = arm();
    const limited_robot robot = limited_arm(model);
    search_options options;
    options.harmonics = 3;
    options.seconds = 1e6;
    options.proceed = [](const search_progress& progress) { return progress.evaluations < 20; };
    const search_result result = search_excitation(robot, arm_form(robot), options);
    EXPECT_TRUE(result.stopped);
    EXPECT_EQ(result.starts, 1);
    ASSERT_TRUE(result.found);
    EXPECT_LE(largest_breach(robot, result.plan).share, 0.0);
}

TEST(ChooseRest, FindsNoneWhereABoxIsOutOfReach) {
    const idim_model_interface model = arm();
    limited_robot robot = limited_arm(model);
    robot.limits.boxes = {{"far box", 1, {0.5, 0.0, 0.0}, {1.6, -1.0, -1.0}, {2.6, 1.0, 1.0}}};
    const rest_choice rest = choose_rest(robot, 1);
    EXPECT_EQ(rest.breach.limit, "far box");
    // The arm of 1.5 m stretched out along x is 0.6 from the centre of the box at 2.1, whose half width is 0.5.
    EXPECT_NEAR(rest.breach.share, 0.2, 1e-4);
}

TEST(ExcitationQuality, TellsWhatCorrelatedColumnsCost) {
    idim_model_interface model{};
    model.dof = 1;
    model.n_base = 2;
    model.joint_names = arm_joint_names;
    model.regressor = [](const double* q, const double* qd, const double*, double, const double*, double* W) {
        W[0] = q[0];
        W[1] = 3.0 * q[0] + 4.0 * qd[0];
    };
    const fourier_series circle{2.0 * std::numbers::pi, Eigen::VectorXd::Zero(1), {{{1, 1.0, 0.0}}}};
    const excitation_quality quality = judge_excitation(model, circle);
    // q = sin t, qd = cos t: the columns have the correlation 3 / 5, so sin of the angle between them is 4 / 5.
    EXPECT_NEAR(quality.inflation[0], 1.25, 1e-12);
    EXPECT_NEAR(quality.inflation[1], 1.25, 1e-12);
    EXPECT_NEAR(quality.scaled_condition_number, std::sqrt(1.6 / 0.4), 1e-12);
    EXPECT_NEAR(quality.independent_torque[1], 4.0 * std::sqrt(0.5), 1e-12);
    // det of 0.5 [1 3; 3 25]
    EXPECT_NEAR(quality.log_determinant, std::log(0.25 * 16.0), 1e-12);
}

}  // namespace
}  // namespace idim
