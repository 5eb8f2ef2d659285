// The optimum of constrained least squares, held against another solver, against its own optimality conditions
// evaluated afresh, and against the published non-convex parametrisation.
#include "consistency/cone_program.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <random>

#include "idim/inertial_body.hpp"
#include "oracles/csdp.hpp"
#include "support/cone_problem.hpp"

namespace idim {
namespace {

using test::normal_matrix;
using test::random_problem;

constexpr int bodies = random_problem::bodies;
constexpr int frictions = random_problem::frictions;
constexpr int parameter_count = random_problem::parameter_count;
constexpr int equations = random_problem::equations;

constexpr double strong_noise = 300.0;

TEST(ConeProgram, ReturnsAConsistentTruthWithoutNoise) {
    const random_problem problem(0.0);
    const cone_solution found = solve(problem.program, problem.start, 1e-8);
    ASSERT_TRUE(found.converged);
    EXPECT_LE(found.gap, 1e-8 * found.objective);
    // sqrt(2 gap) over the smallest singular value of 30 times a random square matrix.
    EXPECT_LT((problem.R * (found.x - problem.truth)).norm(), 1e-4 * (problem.R * problem.truth).norm());
}

TEST(ConeProgram, AgreesWithCsdp) {
    for (const double noise : {1.0, strong_noise}) {
        const random_problem problem(noise);
        const cone_solution found = solve(problem.program, problem.start, 1e-8);
        ASSERT_TRUE(found.converged);
        const auto other = test::solve_with_csdp(problem.program, found.objective);
        ASSERT_TRUE(other) << "csdp cannot be run (package coinor-csdp)";
        // CSDP leaves the constraints by some 1e-8, which buys it what the multipliers say; and it promises seven
        // digits.
        double violation = 0.0;
        double price = 0.0;
        for (std::size_t i = 0; i < problem.program.matrices.size(); ++i) {
            Eigen::MatrixXd F = problem.program.matrices[i].value(other->x);
            F.diagonal().array() -= problem.program.matrices[i].floor;
            violation = std::max(violation, -Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(F).eigenvalues()[0]);
            price += found.multipliers[i].trace();
        }
        for (std::size_t i = 0; i < problem.program.bounds.size(); ++i) {
            violation = std::max(violation, -problem.program.bounds[i].slack(other->x));
            price += std::max(0.0, found.prices[i]);
        }
        EXPECT_LT(violation, 1e-6);
        const double tolerance = violation * price + 3e-7 * found.objective;
        printf("csdp: %.12g by its own account, %.12g at its x, constraints left by %.2g; ours %.12g, gap %.2g\n",
               other->objective, problem.objective(other->x), violation, found.objective, found.gap);
        EXPECT_NEAR(found.objective, problem.objective(other->x), tolerance);
        EXPECT_NEAR(found.objective, other->objective, tolerance);
        // What is g above the optimum has |A (x - x*)| <= sqrt(2 g).
        EXPECT_LT((problem.program.A * (found.x - other->x)).norm(), 2.0 * std::sqrt(2.0 * tolerance));
    }
}

TEST(ConeProgram, MeetsTheOptimalityConditions) {
    const random_problem problem(strong_noise);
    const cone_solution found = solve(problem.program, problem.start, 1e-8);
    ASSERT_TRUE(found.converged);
    const Eigen::VectorXd gradient = problem.program.A.transpose() * (problem.program.A * found.x - problem.program.b);
    Eigen::VectorXd balance = gradient;
    double complementarity = 0.0;
    int active = 0;
    for (int i = 0; i < bodies; ++i) {
        const Eigen::Matrix4d Z = found.multipliers[static_cast<std::size_t>(i)];
        const Eigen::Matrix4d slack = pseudo_inertia(found.x.segment<10>(10 * i)) - 1e-6 * Eigen::Matrix4d::Identity();
        const Eigen::Vector4d eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(Z).eigenvalues();
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(slack).eigenvalues()[0], 0.0);
        // What is below zero in Z counts in the gap with the reach.
        EXPECT_GT(eigenvalues[0], -1e-6 * std::max(1.0, eigenvalues[3]));
        active += static_cast<int>((eigenvalues.array() > 1e-3).count());
        complementarity += Z.cwiseProduct(slack).sum();
        const Eigen::Matrix4d pull = problem.program.matrices[0].reference.inverse();
        const double size_price = found.prices[static_cast<std::size_t>(frictions + i)];
        EXPECT_GE(size_price, 0.0);
        complementarity += size_price * (4.0 * 100.0 - pull.cwiseProduct(slack).sum());
        for (int k = 0; k < 10; ++k) {
            balance[10 * i + k] -= (Z - size_price * pull).cwiseProduct(pseudo_inertia(body_parameters::Unit(k))).sum();
        }
    }
    for (int k = 0; k < frictions; ++k) {
        const double price = found.prices[static_cast<std::size_t>(k)];
        EXPECT_GT(found.x[10 * bodies + k], 0.0);
        EXPECT_GT(price, -1e-6);
        complementarity += price * found.x[10 * bodies + k];
        balance[10 * bodies + k] -= price;
    }
    EXPECT_GT(active, 0);
    // Rounding of the gradient's sums.
    EXPECT_LT(balance.norm(), 1e-11 * problem.program.A.norm() * problem.program.b.norm());
    EXPECT_LE(std::abs(complementarity), 1e-8 * found.objective);
}

TEST(ConeProgram, NoFeasiblePointIsBetterThanTheProofAllows) {
    const random_problem problem(strong_noise);
    std::mt19937_64 random(2);
    // A coarse proof, so that there is room for a point that breaks it.
    for (const double coarse : {1e-1, 1e-4, 1e-8}) {
        const cone_solution found = solve(problem.program, problem.start, coarse);
        ASSERT_TRUE(found.converged);
        EXPECT_LE(found.gap, coarse * found.objective);
        const cone_solution best = solve(problem.program, problem.start, 1e-8);
        EXPECT_GE(best.objective, found.objective - found.gap);
        for (int k = 0; k < 2000; ++k) {
            const Eigen::VectorXd x = problem.feasible(random);
            // Feasible points near the optimum: the set is convex.
            const double share = std::pow(10.0, -static_cast<double>(k % 8));
            EXPECT_GE(problem.objective(found.x + share * (x - found.x)), found.objective - found.gap);
        }
    }
}

/// The published way: parameters that satisfy the constraints by construction, P = floor E + U U' with the diagonal of
/// U and the coefficients as exponentials, by Levenberg and Marquardt.
class log_cholesky_fit {
  public:
    log_cholesky_fit(const random_problem& problem, std::mt19937_64& random)
        : problem_(problem), u_(normal_matrix(parameter_count, 1, random)) {}

    /// x(u) and dx/du [parameters x parameters].
    Eigen::VectorXd point(Eigen::MatrixXd& slope) const {
        Eigen::VectorXd x(parameter_count);
        slope.setZero(parameter_count, parameter_count);
        for (int i = 0; i < bodies; ++i) {
            Eigen::Matrix4d U = Eigen::Matrix4d::Zero();
            int k = 10 * i;
            for (int c = 0; c < 4; ++c) {
                for (int r = c; r < 4; ++r) {
                    U(r, c) = r == c ? std::exp(u_[k++]) : u_[k++];
                }
            }
            x.segment<10>(10 * i) =
                parameters_of_pseudo_inertia(U * U.transpose() + 1e-6 * Eigen::Matrix4d::Identity());
            k = 10 * i;
            for (int c = 0; c < 4; ++c) {
                for (int r = c; r < 4; ++r) {
                    Eigen::Matrix4d dU = Eigen::Matrix4d::Zero();
                    dU(r, c) = r == c ? U(r, c) : 1.0;
                    slope.block<10, 1>(10 * i, k++) =
                        parameters_of_pseudo_inertia(dU * U.transpose() + U * dU.transpose());
                }
            }
        }
        for (int k = 10 * bodies; k < parameter_count; ++k) {
            x[k] = std::exp(u_[k]);
            slope(k, k) = x[k];
        }
        return x;
    }

    double minimise() {
        Eigen::MatrixXd slope;
        Eigen::VectorXd x = point(slope);
        double damping = 1e-3;
        for (int step = 0; step < 500 && damping < 1e12; ++step) {
            Eigen::MatrixXd J(equations + parameter_count, parameter_count);
            J << problem_.program.A * slope,
                Eigen::MatrixXd::Identity(parameter_count, parameter_count) * std::sqrt(damping);
            Eigen::VectorXd r = Eigen::VectorXd::Zero(equations + parameter_count);
            r.head(equations) = problem_.program.b - problem_.program.A * x;
            const Eigen::VectorXd before = u_;
            u_ += J.householderQr().solve(r);
            Eigen::MatrixXd next_slope;
            const Eigen::VectorXd next = point(next_slope);
            const double value = problem_.objective(next);
            if (std::isfinite(value) && value < problem_.objective(x)) {
                x = next;
                slope = next_slope;
                damping *= 0.3;
            } else {
                u_ = before;
                damping *= 4.0;
            }
        }
        return problem_.objective(x);
    }

  private:
    const random_problem& problem_;
    Eigen::VectorXd u_;
};

TEST(ConeProgram, LogCholeskyParametersNeverBeatTheCertifiedOptimum) {
    const random_problem problem(strong_noise);
    const cone_solution found = solve(problem.program, problem.start, 1e-8);
    ASSERT_TRUE(found.converged);
    std::mt19937_64 random(3);
    constexpr int starts = 20;
    int misses = 0;
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < starts; ++k) {
        const double reached = log_cholesky_fit(problem, random).minimise();
        EXPECT_GE(reached, found.objective - found.gap);
        misses += reached > (1.0 + 1e-3) * found.objective ? 1 : 0;
        best = std::min(best, reached);
    }
    RecordProperty("starts_that_miss_by_more_than_a_thousandth", misses);
    printf("log-Cholesky: %d of %d starts miss the optimum by more than a thousandth; the best is %.2g of it above\n",
           misses, starts, best / found.objective - 1.0);
    // The optimum is where some start gets near it: the certificate is not of another problem.
    EXPECT_LT(best, 1.01 * found.objective);
}

TEST(ConeProgram, PriorIsReachedWhereItWeighsEverythingAndLeavesTheOptimumWhereItWeighsNothing) {
    random_problem problem(strong_noise);
    const cone_solution without = solve(problem.program, problem.start, 1e-8);
    double before = without.least_squares;
    for (const double strength : {1e-4, 1.0, 1e4, 1e12}) {
        for (matrix_constraint& body : problem.program.matrices) {
            body.prior = strength;
        }
        const cone_solution found = solve(problem.program, problem.start, 1e-8);
        ASSERT_TRUE(found.converged) << strength << " gap " << found.gap / found.objective;
        EXPECT_GE(found.least_squares, before * (1.0 - 1e-7)) << "more weight on the prior, a better fit";
        before = found.least_squares;
        if (strength == 1e-4) {
            // Divergences of tens.
            EXPECT_LT(found.least_squares, without.least_squares + 1.0);
        }
        if (strength == 1e12) {
            for (int i = 0; i < bodies; ++i) {
                EXPECT_LT((pseudo_inertia(found.x.segment<10>(10 * i)) - problem.program.matrices[0].reference).norm(),
                          1e-2);
            }
        }
    }
}

/// The derivative of the solution against differences of two solutions: with active constraints and all.
TEST(ConeProgram, SensitivityIsTheDerivativeOfTheSolution) {
    random_problem problem(strong_noise);
    const cone_solution found = solve(problem.program, problem.start, 1e-10);
    std::mt19937_64 random(4);
    const Eigen::VectorXd direction = normal_matrix(equations, 1, random);
    constexpr double step = 1e-2;
    problem.program.b += step * direction;
    const Eigen::VectorXd ahead = problem.R * solve(problem.program, problem.start, 1e-10).x;
    problem.program.b -= 2.0 * step * direction;
    const Eigen::VectorXd behind = problem.R * solve(problem.program, problem.start, 1e-10).x;
    const Eigen::VectorXd expected = (ahead - behind) / (2.0 * step);
    const Eigen::VectorXd actual = problem.R * found.sensitivity * direction;
    // Weights of the barrier that are not zero, and the curvature over the step.
    EXPECT_LT((actual - expected).norm(), 1e-2 * expected.norm());
}

TEST(ConeProgram, RefusesAStartOutside) {
    random_problem problem(0.0);
    Eigen::VectorXd start = problem.start;
    start[parameter_count - 1] = -1.0;
    EXPECT_THROW(solve(problem.program, start, 1e-8), std::invalid_argument);
    start = problem.start;
    start[9] = -1.0;
    EXPECT_THROW(solve(problem.program, start, 1e-8), std::invalid_argument);
}

}  // namespace
}  // namespace idim
