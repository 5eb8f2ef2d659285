#include "consistency/cone_program.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace idim {

namespace {

constexpr int most_newton_steps = 1000;
constexpr double centred_decrement = 1e-6;  // Newton decrement squared, in units of the weight
constexpr double weight_factor = 0.1;       // from one central point to the next
constexpr int most_idle_weights = 3;        // that do not improve the proof: rounding is all that is left
constexpr double rounding_share = 1e-13;    // of |b|^2 / 2: what gradients of double precision can prove
constexpr double shortest_step = 1e-12;
constexpr double boundary_share = 0.99;

Eigen::MatrixXd lower_factor(const Eigen::MatrixXd& F) {
    return F.llt().matrixL();
}

Eigen::MatrixXd slack_of(const matrix_constraint& constraint, const Eigen::VectorXd& x) {
    Eigen::MatrixXd F = constraint.value(x);
    F.diagonal().array() -= constraint.floor;
    return F;
}

/// Strictly, so that every factor exists.
bool is_inside(const cone_program& program, const Eigen::VectorXd& x) {
    return std::all_of(program.bounds.begin(), program.bounds.end(),
                       [&x](const linear_constraint& bound) { return bound.slack(x) > 0.0; }) &&
           std::all_of(program.matrices.begin(), program.matrices.end(), [&x](const matrix_constraint& constraint) {
               return slack_of(constraint, x).llt().info() == Eigen::Success;
           });
}

/// L^-1 F L^-T.
Eigen::MatrixXd whitened(const Eigen::MatrixXd& L, const Eigen::MatrixXd& F) {
    const Eigen::MatrixXd half = L.triangularView<Eigen::Lower>().solve(F);
    return L.triangularView<Eigen::Lower>().solve(half.transpose());
}

/// The elements of a symmetric matrix as a vector with the same inner product.
Eigen::VectorXd as_vector(const Eigen::MatrixXd& S) {
    Eigen::VectorXd v(S.rows() * (S.rows() + 1) / 2);
    Eigen::Index k = 0;
    for (Eigen::Index c = 0; c < S.cols(); ++c) {
        for (Eigen::Index r = 0; r < c; ++r) {
            v[k++] = std::sqrt(2.0) * S(r, c);
        }
        v[k++] = S(c, c);
    }
    return v;
}

/// weight times [-log det F + tr(F_0^-1 F)], F = F(x) - shift E, at a point.
struct divergence_term {
    const matrix_constraint& of;
    double weight = 0.0;
    bool is_prior = false;
    Eigen::MatrixXd L;  ///< F = L L'
};

std::vector<divergence_term> terms_at(const cone_program& program, const Eigen::VectorXd& x, double weight) {
    std::vector<divergence_term> terms;
    for (const matrix_constraint& constraint : program.matrices) {
        terms.push_back({constraint, weight, false, lower_factor(slack_of(constraint, x))});
        if (constraint.prior > 0.0) {
            terms.push_back({constraint, constraint.prior, true, lower_factor(constraint.value(x))});
        }
    }
    return terms;
}

/// Rows J and right-hand side r whose least squares solution is the Newton step: J'J is the Hessian, J'r minus the
/// gradient.
struct newton_rows {
    Eigen::MatrixXd J;
    Eigen::VectorXd r;
    Eigen::VectorXd barrier;  ///< the part of r that is the barrier's
};

newton_rows rows_at(const cone_program& program, const std::vector<divergence_term>& terms, const Eigen::VectorXd& x,
                    double weight) {
    Eigen::Index height = program.A.rows() + static_cast<Eigen::Index>(program.bounds.size());
    for (const divergence_term& term : terms) {
        height += term.L.rows() * (term.L.rows() + 1) / 2;
    }
    newton_rows rows{Eigen::MatrixXd::Zero(height, x.size()), Eigen::VectorXd::Zero(height),
                     Eigen::VectorXd::Zero(height)};
    rows.J.topRows(program.A.rows()) = program.A;
    rows.r.head(program.A.rows()) = program.b - program.A * x;
    Eigen::Index at = program.A.rows();
    for (const divergence_term& term : terms) {
        const Eigen::Index size = term.L.rows() * (term.L.rows() + 1) / 2;
        const double root = std::sqrt(term.weight);
        for (std::size_t k = 0; k < term.of.places.size(); ++k) {
            rows.J.block(at, term.of.places[k], size, 1) = root * as_vector(whitened(term.L, term.of.basis[k]));
        }
        const Eigen::MatrixXd pull = term.L.transpose() * term.of.reference.llt().solve(term.L);
        rows.r.segment(at, size) = root * as_vector(Eigen::MatrixXd::Identity(term.L.rows(), term.L.rows()) - pull);
        if (!term.is_prior) {
            rows.barrier.segment(at, size) = rows.r.segment(at, size);
        }
        at += size;
    }
    for (const linear_constraint& bound : program.bounds) {
        const double slack = bound.slack(x);
        for (const linear_constraint::term& term : bound.terms) {
            rows.J(at, term.place) += std::sqrt(weight) * term.factor / slack;
        }
        rows.r[at] = std::sqrt(weight) * (1.0 - (bound.reference > 0.0 ? slack / bound.reference : 0.0));
        rows.barrier[at] = rows.r[at];
        ++at;
    }
    return rows;
}

/// Least squares through QR with columns of norm 1; the smallest solution where columns depend on one another. Rows
/// differ by many orders of magnitude: with the largest first, and pivoted columns, each keeps its own relative
/// precision [Cox and Higham 1998, BIT 38].
class scaled_least_squares {
  public:
    explicit scaled_least_squares(const Eigen::MatrixXd& J)
        : scale_(J.colwise().norm().transpose()), order_(static_cast<std::size_t>(J.rows())) {
        scale_ = (scale_.array() > 0.0).select(scale_.cwiseInverse(), 1.0);
        const Eigen::MatrixXd scaled = J * scale_.asDiagonal();
        const Eigen::VectorXd size = scaled.rowwise().norm();
        std::iota(order_.begin(), order_.end(), 0);
        std::stable_sort(order_.begin(), order_.end(),
                         [&size](Eigen::Index a, Eigen::Index b) { return size[a] > size[b]; });
        qr_.setThreshold(1e-14);
        qr_.compute(scaled(order_, Eigen::all));
    }
    Eigen::MatrixXd solve(const Eigen::MatrixXd& r) const {
        return scale_.asDiagonal() * Eigen::MatrixXd(qr_.solve(r(order_, Eigen::all)));
    }

  private:
    Eigen::VectorXd scale_;
    std::vector<Eigen::Index> order_;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr_;
};

/// The objective with its barrier along a line, but for a constant: slope a + curvature a^2 / 2 - sum of weight log(1 +
/// rate a).
struct line {
    double slope = 0.0;
    double curvature = 0.0;
    std::vector<std::pair<double, double>> logarithms;  ///< weight, rate

    double derivative(double a) const {
        double sum = slope + curvature * a;
        for (const auto& [weight, rate] : logarithms) {
            sum -= weight * rate / (1.0 + rate * a);
        }
        return sum;
    }
    /// The minimum, at most a full Newton step and short of the boundary.
    double minimum() const {
        double high = 1.0;
        for (const auto& [weight, rate] : logarithms) {
            high = rate < 0.0 ? std::min(high, -boundary_share / rate) : high;
        }
        if (derivative(high) <= 0.0) {
            return high;
        }
        double low = 0.0;
        while (high - low > 1e-3 * high) {
            const double middle = 0.5 * (low + high);
            (derivative(middle) > 0.0 ? high : low) = middle;
        }
        return low;
    }
};

line along(const cone_program& program, const std::vector<divergence_term>& terms, const Eigen::VectorXd& x,
           const Eigen::VectorXd& step, double weight) {
    line result;
    const Eigen::VectorXd moved = program.A * step;
    result.slope = moved.dot(program.A * x - program.b);
    result.curvature = moved.squaredNorm();
    for (const divergence_term& term : terms) {
        const Eigen::MatrixXd dF = term.of.value(step);
        result.slope += term.weight * term.of.reference.llt().solve(dF).trace();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(whitened(term.L, dF), Eigen::EigenvaluesOnly);
        for (const double rate : eigen.eigenvalues()) {
            result.logarithms.emplace_back(term.weight, rate);
        }
    }
    for (const linear_constraint& bound : program.bounds) {
        const double change = bound.slack(step) + bound.low;
        result.slope += bound.reference > 0.0 ? weight * change / bound.reference : 0.0;
        result.logarithms.emplace_back(weight, change / bound.slack(x));
    }
    return result;
}

/// -log det(F F_0^-1) + tr(F_0^-1 F) - dim.
double divergence(const Eigen::MatrixXd& F, const Eigen::MatrixXd& reference) {
    const Eigen::MatrixXd pull = reference.llt().solve(F);
    const Eigen::MatrixXd L = lower_factor(F);
    const Eigen::MatrixXd L0 = lower_factor(reference);
    return 2.0 * (L0.diagonal().array().log().sum() - L.diagonal().array().log().sum()) + pull.trace() -
           static_cast<double>(F.rows());
}

void evaluate(const cone_program& program, cone_solution& at) {
    at.least_squares = program.constant + 0.5 * (program.A * at.x - program.b).squaredNorm();
    at.objective = at.least_squares;
    for (const matrix_constraint& constraint : program.matrices) {
        if (constraint.prior > 0.0) {
            at.objective += constraint.prior * divergence(constraint.value(at.x), constraint.reference);
        }
    }
}

/// The symmetric matrix of least norm with this adjoint.
Eigen::MatrixXd matrix_with_adjoint(const matrix_constraint& constraint, const Eigen::VectorXd& adjoint) {
    const auto size = static_cast<Eigen::Index>(constraint.basis.size());
    Eigen::MatrixXd gram(size, size);
    for (Eigen::Index k = 0; k < size; ++k) {
        gram.col(k) = constraint.adjoint(constraint.basis[static_cast<std::size_t>(k)]);
    }
    const Eigen::VectorXd factor = gram.llt().solve(adjoint);
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(constraint.reference.rows(), constraint.reference.cols());
    for (Eigen::Index k = 0; k < size; ++k) {
        Z += factor[k] * constraint.basis[static_cast<std::size_t>(k)];
    }
    return Z;
}

/// Gradient of the objective, without the barrier.
Eigen::VectorXd gradient_at(const cone_program& program, const Eigen::VectorXd& x) {
    Eigen::VectorXd gradient = program.A.transpose() * (program.A * x - program.b);
    for (const matrix_constraint& constraint : program.matrices) {
        if (constraint.prior > 0.0) {
            const Eigen::MatrixXd slope = constraint.reference.inverse() - constraint.value(x).inverse();
            gradient(constraint.places) += constraint.prior * constraint.adjoint(slope);
        }
    }
    return gradient;
}

double reach_of(const cone_program& program, const Eigen::VectorXd& x) {
    double farthest = 10.0;
    for (const linear_constraint& bound : program.bounds) {
        farthest = bound.reference > 0.0 ? std::max(farthest, bound.slack(x) / bound.reference) : farthest;
    }
    return 10.0 * farthest;
}

/// Multipliers that balance the gradient, and the gap they prove: with f convex and g its gradient at x, for every
/// feasible y
///     f(y) >= f(x) + g'(y - x) = f(x) - sum of <Z, F(x) - floor E> + sum of <Z, F(y) - floor E> and likewise of the
///     bounds,
/// where the second sum is at least -shortfall size dim for Z + shortfall F_0^-1 >= 0.
void certify(const cone_program& program, cone_solution& at) {
    Eigen::VectorXd rest = gradient_at(program, at.x);
    std::vector<bool> is_owned(static_cast<std::size_t>(at.x.size()), false);
    at.reach = reach_of(program, at.x);
    at.gap = 0.0;
    for (std::size_t i = 0; i < program.bounds.size(); ++i) {
        const linear_constraint& bound = program.bounds[i];
        double& price = at.prices[i];
        if (bound.reference > 0.0) {
            price = rest[bound.terms[0].place] / bound.terms[0].factor;
            is_owned[static_cast<std::size_t>(bound.terms[0].place)] = true;
        }
        for (const linear_constraint::term& term : bound.terms) {
            rest[term.place] -= price * term.factor;
        }
        at.gap += price * bound.slack(at.x) + std::max(0.0, -price) * at.reach * bound.reference;
    }
    for (std::size_t i = 0; i < program.matrices.size(); ++i) {
        const matrix_constraint& constraint = program.matrices[i];
        Eigen::MatrixXd& Z = at.multipliers[i];
        const Eigen::VectorXd remaining = rest(constraint.places) - constraint.adjoint(Z);
        Z += matrix_with_adjoint(constraint, remaining);
        const Eigen::MatrixXd L0 = lower_factor(constraint.reference);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(L0.transpose() * Z * L0, Eigen::EigenvaluesOnly);
        const double shortfall = std::max(0.0, -eigen.eigenvalues()[0]);
        at.gap += Z.cwiseProduct(constraint.value(at.x)).sum() - constraint.floor * Z.trace() +
                  shortfall * constraint.size * static_cast<double>(Z.rows());
        for (const Eigen::Index place : constraint.places) {
            is_owned[static_cast<std::size_t>(place)] = true;
        }
    }
    for (Eigen::Index k = 0; k < at.x.size(); ++k) {
        at.gap += is_owned[static_cast<std::size_t>(k)] ? 0.0 : std::abs(rest[k] * at.x[k]) * (1.0 + at.reach);
    }
}

double largest_gap(const cone_program& program, const cone_solution& at, double relative_gap) {
    return std::max(relative_gap * at.objective, rounding_share * 0.5 * program.b.squaredNorm());
}

/// Multipliers that a full Newton step from `x` makes: those of the barrier there, moved along with it. They balance
/// the gradient of a quadratic objective where the step ends, but for rounding.
void set_multipliers(const cone_program& program, const std::vector<divergence_term>& terms, const Eigen::VectorXd& x,
                     const Eigen::VectorXd& step, cone_solution& at) {
    at.prices.clear();
    for (const linear_constraint& bound : program.bounds) {
        const double slack = bound.slack(x);
        at.prices.push_back(std::max(0.0, at.weight / slack * (1.0 - (bound.slack(step) + bound.low) / slack)));
    }
    at.multipliers.clear();
    for (const divergence_term& term : terms) {
        if (term.is_prior) {
            continue;  // belongs to the objective
        }
        const auto E = Eigen::MatrixXd::Identity(term.L.rows(), term.L.rows());
        const Eigen::MatrixXd inverse = term.L.triangularView<Eigen::Lower>().solve(E);
        const Eigen::MatrixXd inner = E - whitened(term.L, term.of.value(step));
        at.multipliers.push_back(at.weight * (inverse.transpose() * inner * inverse - term.of.reference.inverse()));
    }
}

/// Newton's method to the central point of at.weight; false where it stalls.
bool centre(const cone_program& program, cone_solution& at) {
    double before = std::numeric_limits<double>::infinity();
    while (at.steps < most_newton_steps) {
        const std::vector<divergence_term> terms = terms_at(program, at.x, at.weight);
        const newton_rows rows = rows_at(program, terms, at.x, at.weight);
        const Eigen::VectorXd step = scaled_least_squares(rows.J).solve(rows.r);
        const double decrement = (rows.J * step).squaredNorm() / at.weight;
        if (!std::isfinite(decrement)) {
            return false;
        }
        // Below 1 a Newton step squares the decrement: where it does not, rounding is all that is left.
        const bool arrives =
            decrement < centred_decrement || (before < 1e-2 && decrement < 0.1 && decrement > 0.1 * before);
        double length = arrives ? 1.0 : along(program, terms, at.x, step, at.weight).minimum();
        while (length > shortest_step && !is_inside(program, at.x + length * step)) {
            length *= 0.5;  // the boundary is nearer than rounding tells
        }
        if (length <= shortest_step) {
            return false;
        }
        set_multipliers(program, terms, at.x, step, at);
        at.x += length * step;
        ++at.steps;
        if (arrives) {
            return true;
        }
        before = decrement;
    }
    return false;
}

/// The sizes of the matrix constraints as bounds behind the others.
cone_program with_sizes(cone_program program) {
    for (const matrix_constraint& constraint : program.matrices) {
        const Eigen::VectorXd share = constraint.adjoint(constraint.reference.inverse());
        linear_constraint& bound = program.bounds.emplace_back();
        bound.name = "size of the " + constraint.name;
        bound.low = -constraint.size * static_cast<double>(constraint.reference.rows());
        for (std::size_t k = 0; k < constraint.places.size(); ++k) {
            bound.terms.push_back({constraint.places[k], -share[static_cast<Eigen::Index>(k)]});
        }
    }
    return program;
}

/// Lowers the weight and follows the tangent of the central points to it, as far as it stays inside: a Newton step
/// alone would aim slacks that should shrink to a tenth far beyond the boundary.
void lower_weight(const cone_program& program, cone_solution& at) {
    const newton_rows rows = rows_at(program, terms_at(program, at.x, at.weight), at.x, at.weight);
    const Eigen::VectorXd step = scaled_least_squares(rows.J).solve((weight_factor - 1.0) * rows.barrier);
    at.weight *= weight_factor;
    double length = 1.0;
    while (length > shortest_step && !is_inside(program, at.x + length * step)) {
        length *= 0.5;
    }
    if (length > shortest_step) {
        at.x += length * step;
    }
}

}  // namespace

Eigen::MatrixXd matrix_constraint::value(const Eigen::VectorXd& x) const {
    Eigen::MatrixXd F = Eigen::MatrixXd::Zero(basis[0].rows(), basis[0].cols());
    for (std::size_t k = 0; k < places.size(); ++k) {
        F += x[places[k]] * basis[k];
    }
    return F;
}

Eigen::VectorXd matrix_constraint::adjoint(const Eigen::MatrixXd& Z) const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(basis.size()));
    for (std::size_t k = 0; k < basis.size(); ++k) {
        result[static_cast<Eigen::Index>(k)] = Z.cwiseProduct(basis[k]).sum();
    }
    return result;
}

double linear_constraint::slack(const Eigen::VectorXd& x) const {
    return std::accumulate(terms.begin(), terms.end(), -low,
                           [&x](double sum, const term& t) { return sum + t.factor * x[t.place]; });
}

cone_solution solve(const cone_program& stated, const Eigen::VectorXd& start, double relative_gap) {
    const cone_program program = with_sizes(stated);
    if (!is_inside(program, start)) {
        throw std::invalid_argument("a start outside the constraints, expected one strictly inside");
    }
    cone_solution best;
    best.x = start;
    evaluate(program, best);
    double dimension = static_cast<double>(program.bounds.size());
    for (const matrix_constraint& constraint : program.matrices) {
        dimension += static_cast<double>(constraint.reference.rows());
    }
    best.weight = std::max(best.objective, 1e-12 * program.b.squaredNorm()) / std::max(dimension, 1.0);
    best.gap = std::numeric_limits<double>::infinity();
    cone_solution at = best;
    for (int idle = 0; idle < most_idle_weights && !best.converged && centre(program, at); lower_weight(program, at)) {
        evaluate(program, at);
        certify(program, at);
        at.converged = at.gap <= largest_gap(program, at, relative_gap);
        idle = at.gap < best.gap ? 0 : idle + 1;
        best = at.gap < best.gap ? at : best;
    }
    best.steps = at.steps;
    const newton_rows rows = rows_at(program, terms_at(program, best.x, best.weight), best.x, best.weight);
    Eigen::MatrixXd data = Eigen::MatrixXd::Zero(rows.J.rows(), program.A.rows());
    data.topRows(program.A.rows()).setIdentity();
    best.sensitivity = scaled_least_squares(rows.J).solve(data);
    return best;
}

}  // namespace idim
