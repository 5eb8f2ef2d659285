#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace idim {

/// F(x) - floor E positive semi-definite, F(x) = sum over k of x[places[k]] basis[k].
struct matrix_constraint {
    std::string name;
    std::vector<Eigen::Index> places;
    std::vector<Eigen::MatrixXd> basis;  ///< symmetric
    double floor = 0.0;
    Eigen::MatrixXd reference;  ///< F_0 > floor E: what F is near where nothing else decides
    double size = 100.0;        ///< tr(F_0^-1 F) <= size dim: without it an optimum may lie at infinity
    double prior = 0.0;         ///< weight in the objective of the divergence of F from F_0

    Eigen::MatrixXd value(const Eigen::VectorXd& x) const;
    /// <Z, basis[k]> for every k: the adjoint of F.
    Eigen::VectorXd adjoint(const Eigen::MatrixXd& Z) const;
};

/// sum of factor x[place] over the terms >= low.
struct linear_constraint {
    struct term {
        Eigen::Index place = 0;
        double factor = 1.0;
    };

    std::string name;
    std::vector<term> terms;
    double low = 0.0;
    /// Size of the slack where nothing else decides. A constraint with one is the only one of its one variable; without
    /// (0) its variables belong to matrix constraints.
    double reference = 0.0;

    double slack(const Eigen::VectorXd& x) const;
};

/// Minimise |A x - b|^2 / 2 + sum of prior D(F(x) || F_0), D the log-det divergence [Lee, Wensing and Park 2020, IEEE
/// Transactions on Robotics 36] D(F || F_0) = -log det(F F_0^-1) + tr(F_0^-1 F) - dim, under the constraints. Convex.
struct cone_program {
    Eigen::MatrixXd A;
    Eigen::VectorXd b;
    std::vector<matrix_constraint> matrices;
    std::vector<linear_constraint> bounds;
    double constant = 0.0;  ///< added to the objective: what no x can change
};

/// The optimum, how far it can be from the true one, and how it moves.
struct cone_solution {
    Eigen::VectorXd x;           ///< strictly inside every constraint
    double objective = 0.0;      ///< constant included
    double least_squares = 0.0;  ///< constant + |A x - b|^2 / 2
    /// No feasible point has an objective below objective - gap, with slacks of bounds that have a reference below
    /// `reach` references, and free variables below `reach` times their value.
    double gap = 0.0;
    double reach = 0.0;                        ///< 100, or ten times as far as x is
    double weight = 0.0;                       ///< of the barrier, at the end
    std::vector<Eigen::MatrixXd> multipliers;  ///< of the matrix constraints
    std::vector<double> prices;   ///< multipliers of the bounds, then of the sizes of the matrix constraints
    Eigen::MatrixXd sensitivity;  ///< dx/db
    int steps = 0;                ///< of Newton
    bool converged = false;
};

/// Barrier method [Boyd and Vandenberghe 2004, Convex Optimization, section 11.3]: minimises the objective plus
/// `weight` times
///     D(F - floor E || F_0) of every matrix constraint and -log(slack) + slack / reference of every bound
/// for falling weights, along the tangent from one central point to the next. Each Newton step is the least squares
/// solution, by QR with columns of norm 1, of A and the rows that the factors of the constraints give: the Hessian,
/// whose condition is the square of these rows', is never formed. The line search is exact, since along a line the
/// barrier separates into the eigenvalues of the step in the metric of the factors. What the objective leaves open
/// comes out where the divergences have their minimum: near F_0.
///
/// Ends when the gap is below `relative_gap` of the objective (or 1e-14 of |b|^2 / 2 where that is more). The gap is
/// that of an explicit dual point: multipliers Z with <Z, F(y)> in the place of the gradient, whose eigenvalues below
/// zero, from rounding or from centring, count with `reach`.
///
/// `start` must be strictly inside all constraints (std::invalid_argument else). Where Newton's method stalls
/// `converged` is false and the gap is the one reached.
cone_solution solve(const cone_program& program, const Eigen::VectorXd& start, double relative_gap);

}  // namespace idim
