#include "idim/consistent_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <utility>

#include "consistency/consistency_program.hpp"
#include "regrouping.hpp"
#include "sandwich.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

constexpr double relative_gap = 1e-8;
constexpr int scanned_configurations = 100000;
// A constraint is active if relaxing it by the scale of its parameters would lower the objective by more than this
// part.
constexpr double active_share = 1e-5;
constexpr double gap_multiple = 100.0;  // and by more than what the proof leaves open
constexpr double held_share = 1e-3;

/// R [columns x (s + columns of single logs)]: the parameters of the columns of `rows` from the standard parameters
/// and, behind them, those that single logs have of their own.
Eigen::MatrixXd regrouping_over_logs(const idim_model_interface& model, const observation& rows) {
    const Eigen::Index own = rows.n_base - model.n_base;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(rows.n_base, model.n_standard + own);
    R.topLeftCorner(model.n_base, model.n_standard) = regrouping_of(model);
    R.bottomRightCorner(own, own).setIdentity();
    return R;
}

parameter_scale scale_of(const Eigen::VectorXd& standard, const physical_parameters& known) {
    Eigen::VectorXd others = standard.cwiseAbs();
    parameter_scale scale{0.0, 0.0};
    for (const inertial_body& body : known.bodies) {
        scale.inertial = std::max(scale.inertial, body.of(standard).cwiseAbs().maxCoeff());
        others(body.places).setZero();
    }
    scale.coefficient = others.size() > 0 ? others.maxCoeff() : 0.0;
    // A robot whose parameters are all zero still needs a scale.
    scale.inertial = scale.inertial > 0.0 ? scale.inertial : 1.0;
    scale.coefficient = scale.coefficient > 0.0 ? scale.coefficient : 1.0;
    return scale;
}

/// Coefficients that move a torque: nothing bounds the others from above.
physical_parameters with_effect_only(physical_parameters known, const Eigen::MatrixXd& R) {
    std::erase_if(known.coefficients, [&R](const auto& bound) { return R.col(bound.place).isZero(0.0); });
    return known;
}

std::vector<consistent_body> describe(const physical_parameters& known, const Eigen::VectorXd& standard) {
    std::vector<consistent_body> bodies;
    for (const inertial_body& body : known.bodies) {
        const body_parameters p = body.of(standard);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> central(central_inertia(p), Eigen::EigenvaluesOnly);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> pseudo(pseudo_inertia(p), Eigen::EigenvaluesOnly);
        bodies.push_back({body.name, p[9], p.segment<3>(6) / p[9], central.eigenvalues()[0], pseudo.eigenvalues()[0]});
    }
    return bodies;
}

std::vector<active_constraint> active_of(const cone_program& program, const cone_solution& solution,
                                         const parameter_scale& scale) {
    std::vector<active_constraint> active;
    const double least = std::max(active_share * solution.objective, gap_multiple * solution.gap);
    for (std::size_t k = 0; k < program.matrices.size(); ++k) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(solution.multipliers[k], Eigen::EigenvaluesOnly);
        const Eigen::VectorXd& prices = eigen.eigenvalues();
        const auto held = (prices.array() * scale.inertial > least).count();
        if (held > 0) {
            active.push_back(
                {fmt::format("{}: {} of {} eigenvalues at the floor", program.matrices[k].name, held, prices.size()),
                 prices.maxCoeff()});
        }
    }
    for (std::size_t k = 0; k < program.matrices.size(); ++k) {
        const matrix_constraint& body = program.matrices[k];
        if (solution.prices[program.bounds.size() + k] * body.size * static_cast<double>(body.reference.rows()) >
            least) {
            active.push_back({"largest size of the " + body.name, solution.prices[program.bounds.size() + k]});
        }
    }
    for (std::size_t k = 0; k < program.bounds.size(); ++k) {
        const linear_constraint& bound = program.bounds[k];
        const double size = bound.reference > 0.0 ? bound.reference : scale.inertial;
        if (solution.prices[k] * size > least) {
            active.push_back({bound.name, solution.prices[k]});
        }
    }
    return active;
}

double sum_of_squares(const joint_series& series) {
    double sum = 0.0;
    for (const std::vector<Eigen::VectorXd>& segments : series) {
        for (const Eigen::VectorXd& segment : segments) {
            sum += segment.squaredNorm();
        }
    }
    return sum;
}

/// Fills the deviations of a constrained estimate: `carried` is its derivative by that of weighted least squares in the
/// coordinates of the orthonormal columns of the weighted W.
void add_carried_deviations(const observation& rows, const std::vector<double>& joint_weight,
                            const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& carried, estimate& fit) {
    const joint_series score = scaled(residuals(rows, fit.chi), joint_weight);
    sandwich robust = robust_covariance(rows, joint_weight, inverse, carried, score);
    fit.covariance = std::move(robust.covariance);
    fit.correlation_length = std::move(robust.correlation_length);
    fit.std_white =
        std::sqrt(sum_of_squares(score) / static_cast<double>(rows.rows() - rows.n_base)) * carried.rowwise().norm();
}

void set_objective(cone_program& program, consistency_objective objective, const stacked_qr& qr,
                   const Eigen::MatrixXd& R, double remaining) {
    const Eigen::MatrixXd S = qr.R * qr.column_norm.asDiagonal();
    if (objective == consistency_objective::weighted) {
        program.A = S * R;
        program.b = qr.z;
        program.constant = remaining;
    } else {
        program.A = S.transpose() * (S * R);
        program.b = S.transpose() * qr.z;
    }
}

/// Base parameters of the optimum, their errors and deviations.
void fill_estimate(const observation& rows, const std::vector<double>& weight, const stacked_qr& qr,
                   const Eigen::MatrixXd& R, consistency_objective objective, const cone_solution& solution,
                   consistent_estimate& result) {
    estimate& fit = result.fit;
    fit.chi = R * solution.x;
    fit.converged = solution.converged;
    fit.residual = errors(rows, fit.chi);
    fit.joint_deviation = joint_deviations(rows, residuals(rows, fit.chi), qr.parameter_share());
    const Eigen::MatrixXd S = qr.R * qr.column_norm.asDiagonal();
    const Eigen::MatrixXd by_data = objective == consistency_objective::weighted
                                        ? Eigen::MatrixXd::Identity(S.rows(), S.cols())
                                        : Eigen::MatrixXd(S.transpose());
    const Eigen::MatrixXd carried = R * solution.sensitivity * by_data;
    const Eigen::MatrixXd inverse = qr.inverse();
    add_carried_deviations(rows, weight, inverse, carried, fit);
    for (Eigen::Index k = 0; k < fit.chi.size(); ++k) {
        result.at_bound.push_back(carried.row(k).norm() < held_share * inverse.row(k).norm());
    }
    fit.message =
        fmt::format("{} in {} Newton steps: no consistent parameters have an objective lower by more than {:.2g} of it",
                    fit.converged ? "optimal" : "stalled", solution.steps, solution.gap / solution.objective);
}

}  // namespace

consistent_estimate consistent_fit(const idim_model_interface& model, const observation& rows,
                                   const physical_parameters& known_all, const consistency_request& request) {
    consistent_estimate result;
    const std::vector<double> unweighted(static_cast<std::size_t>(rows.dof), 1.0);
    const weighted_solution ordinary = solve_weighted(rows, unweighted);
    if (ordinary.fit.chi.size() == 0) {
        result.fit = ordinary.fit;
        return result;
    }
    // From the rows themselves, not from their triangle: the objective is measured by them, down to rounding.
    const std::vector<double> deviation =
        joint_deviations(rows, residuals(rows, ordinary.fit.chi), ordinary.qr.parameter_share());
    const std::vector<double> weight = request.weights_joints ? weights_of(deviation) : unweighted;
    weighted_solution weighted = solve_weighted(rows, weight);
    result.fit = weighted.fit;
    if (weighted.fit.chi.size() == 0) {
        return result;
    }
    result.unconstrained = weighted_fit(rows, weight);
    const Eigen::MatrixXd R = regrouping_over_logs(model, rows);
    const physical_parameters known = with_effect_only(known_all, R);
    const Eigen::VectorXd least = R.completeOrthogonalDecomposition().solve(weighted.fit.chi);
    const parameter_scale scale = scale_of(least, known);
    std::vector<std::string> names(model.standard_names, model.standard_names + model.n_standard);
    names.resize(static_cast<std::size_t>(R.cols()));
    consistency_program problem = constrain(known, request, scale, names);
    set_objective(problem.program, request.objective, weighted.qr, R,
                  0.5 * sum_of_squares(scaled(residuals(rows, weighted.fit.chi), weight)));
    const cone_solution solution = solve(problem.program, problem.start, relative_gap);

    result.standard = solution.x.head(model.n_standard);
    for (const auto& bound : known_all.coefficients) {
        result.standard[bound.place] =
            R.col(bound.place).isZero(0.0) ? std::numeric_limits<double>::quiet_NaN() : result.standard[bound.place];
    }
    result.bodies = describe(known, solution.x);
    result.active = active_of(problem.program, solution, scale);
    result.floor = problem.floor;
    result.objective = solution.objective;
    result.unconstrained_objective = problem.program.constant;
    result.gap = solution.gap;
    result.steps = solution.steps;

    fill_estimate(rows, weight, weighted.qr, R, request.objective, solution, result);
    result.inertia = scan_inertia(model, result.fit.chi.head(model.n_base), scanned_configurations);
    result.unconstrained_inertia =
        scan_inertia(model, result.unconstrained.chi.head(model.n_base), scanned_configurations);
    return result;
}

}  // namespace idim
