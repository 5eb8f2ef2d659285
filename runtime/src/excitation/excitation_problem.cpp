#include "excitation/excitation_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "excitation/sampled_model.hpp"
#include "parallel.hpp"

namespace idim {

namespace {

constexpr Eigen::Index samples_per_harmonic = 40;
/// The derivative of a smooth regressor by positions or speeds is far below, that of a jump of a sign in one step far
/// above.
constexpr double steepest_slope = 1e3;

/// Mean of exponentials of `values`, not below the largest, and its derivative by each.
double smooth_maximum(const Eigen::ArrayXd& values, double sharpness, Eigen::ArrayXd& weight) {
    const double largest = values.maxCoeff();
    weight = (sharpness * (values - largest)).exp();
    const double sum = weight.sum();
    weight /= sum;
    return largest + std::log(sum) / sharpness;
}

/// Smooth maximum of |values| and its derivative by each value.
double smooth_size(const Eigen::ArrayXd& values, double sharpness, Eigen::ArrayXd& weight) {
    Eigen::ArrayXd both(2 * values.size());
    both << values, -values;
    Eigen::ArrayXd weight_of_both;
    const double size = smooth_maximum(both, sharpness, weight_of_both);
    weight = weight_of_both.head(values.size()) - weight_of_both.tail(values.size());
    return size;
}

Eigen::MatrixXd& signal(motion_samples& motion, int order) {
    return order == 0 ? motion.q : order == 1 ? motion.qd : motion.qdd;
}

const Eigen::MatrixXd& signal(const motion_samples& motion, int order) {
    return order == 0 ? motion.q : order == 1 ? motion.qd : motion.qdd;
}

/// Derivative of the regressors of all samples by one signal of one joint. W is linear in accelerations; the derivative
/// across the jump of a sign is left out.
Eigen::MatrixXd regressor_derivative(const idim_model_interface& model, const motion_samples& motion, int order,
                                     Eigen::Index joint) {
    const double step = order == 2 ? 0.5 : 1e-5;
    motion_samples moved = motion;
    signal(moved, order).col(joint).array() += step;
    Eigen::MatrixXd slope = sampled_regressor(model, moved);
    signal(moved, order).col(joint).array() -= 2.0 * step;
    slope -= sampled_regressor(model, moved);
    slope /= 2.0 * step;
    return (slope.array().abs() < steepest_slope).select(slope, 0.0);
}

}  // namespace

excitation_problem::excitation_problem(const limited_robot& robot, double period, const search_options& options)
    : robot_(robot),
      period_(period),
      criterion_(options.criterion),
      harmonics_(options.harmonics),
      width_(1 + 2 * options.harmonics) {
    const Eigen::Index count = std::max<Eigen::Index>(200, samples_per_harmonic * harmonics_);
    t_ = Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)) * (period / static_cast<double>(count));
    for (Eigen::MatrixXd& basis : basis_) {
        basis = Eigen::MatrixXd::Zero(count, width_);
    }
    const motion_limits& limits = robot.limits;
    basis_[0].col(0).setOnes();
    scale_.resize(width_, robot.model.dof);
    scale_.row(0) = limits.half_range().transpose();
    for (int m = 1; m <= harmonics_; ++m) {
        const double w = 2.0 * std::numbers::pi * m / period;
        const Eigen::VectorXd sine = (w * t_.array()).sin();
        const Eigen::VectorXd cosine = (w * t_.array()).cos();
        basis_[0].middleCols(2 * m - 1, 2) << sine, cosine;
        basis_[1].middleCols(2 * m - 1, 2) << w * cosine, -w * sine;
        basis_[2].middleCols(2 * m - 1, 2) << -w * w * sine, -w * w * cosine;
        const Eigen::VectorXd largest =
            limits.half_range().cwiseMin(limits.velocity / w).cwiseMin(limits.acceleration / (w * w));
        scale_.middleRows(2 * m - 1, 2) = largest.transpose().replicate(2, 1);
    }
    for (Eigen::Index j = 0; robot.limits_torque() && j < robot.model.dof; ++j) {
        if (std::isfinite(limits.torque[j])) {
            torque_limited_.push_back(j);
        }
    }
}

Eigen::Index excitation_problem::constraints() const {
    const auto accelerations = (robot_.limits.acceleration.array().isFinite()).count();
    return 2 * robot_.model.dof + accelerations + static_cast<Eigen::Index>(robot_.limits.boxes.size()) +
           static_cast<Eigen::Index>(torque_limited_.size());
}

motion_samples excitation_problem::motion(const Eigen::VectorXd& u) const {
    const Eigen::MatrixXd coefficients = u.reshaped(width_, robot_.model.dof).cwiseProduct(scale_);
    motion_samples result{t_, basis_[0] * coefficients, basis_[1] * coefficients, basis_[2] * coefficients};
    result.q.rowwise() += robot_.limits.centre().transpose();
    return result;
}

fourier_series excitation_problem::series(const Eigen::VectorXd& u) const {
    const Eigen::MatrixXd coefficients = u.reshaped(width_, robot_.model.dof).cwiseProduct(scale_);
    fourier_series result{period_, robot_.limits.centre() + coefficients.row(0).transpose(), {}};
    for (Eigen::Index j = 0; j < coefficients.cols(); ++j) {
        std::vector<harmonic> terms;
        for (int m = 1; m <= harmonics_; ++m) {
            terms.push_back({m, coefficients(2 * m - 1, j), coefficients(2 * m, j)});
        }
        result.joints.push_back(terms);
    }
    return result;
}

Eigen::VectorXd excitation_problem::at(const Eigen::VectorXd& rest) const {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(variables());
    for (Eigen::Index j = 0; j < rest.size(); ++j) {
        u[j * width_] = (rest[j] - robot_.limits.centre()[j]) / robot_.limits.half_range()[j];
    }
    return u;
}

Eigen::VectorXd excitation_problem::reduced(const Eigen::VectorXd& u, const Eigen::VectorXd& rest,
                                            double factor) const {
    const Eigen::VectorXd still = at(rest);
    return still + factor * (u - still);
}

Eigen::VectorXd excitation_problem::start(const Eigen::VectorXd& rest, const Eigen::VectorXd& shape) const {
    constexpr int most_reductions = 30;
    const Eigen::VectorXd still = at(rest);
    Eigen::VectorXd u = still + shape;
    for (Eigen::Index j = 0; j < rest.size(); ++j) {
        u[j * width_] = still[j * width_];
    }
    for (int k = 0; k < most_reductions && largest_breach(robot_, motion(u)).share > -0.05; ++k) {
        u = still + 0.8 * (u - still);
    }
    return u;
}

problem_value excitation_problem::evaluate(const Eigen::VectorXd& u, const smoothing& form) const {
    const motion_samples samples = motion(u);
    problem_value value;
    value.gradient = Eigen::VectorXd::Zero(variables());
    value.constraints = Eigen::VectorXd::Zero(constraints());
    value.jacobian = Eigen::MatrixXd::Zero(variables(), constraints());
    value.breach = largest_breach(robot_, samples).share;
    add_joint_limits(samples, form, value);
    add_boxes(samples, form, value);
    add_model(samples, form, value);
    return value;
}

problem_value excitation_problem::figure(const Eigen::VectorXd& u) const {
    const motion_samples samples = motion(u);
    problem_value value;
    value.breach = largest_breach(robot_, samples).share;
    value.figure = criterion(sampled_regressor(robot_.model, samples), 1.0).figure;
    return value;
}

gram_value excitation_problem::criterion(const Eigen::MatrixXd& W, double power) const {
    const Eigen::Index b = robot_.model.n_base;
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(b, b);
    for (Eigen::Index i = 0; i < robot_.model.dof; ++i) {
        G.selfadjointView<Eigen::Lower>().rankUpdate(W.middleCols(i * b, b).transpose(),
                                                     1.0 / static_cast<double>(W.rows()));
    }
    const Eigen::MatrixXd whole = G.selfadjointView<Eigen::Lower>();
    return criterion_of(whole, criterion_, power);
}

void excitation_problem::add_joint_limits(const motion_samples& samples, const smoothing& form,
                                          problem_value& value) const {
    const motion_limits& limits = robot_.limits;
    const std::array<Eigen::VectorXd, 3> largest = {limits.half_range(), limits.velocity, limits.acceleration};
    Eigen::Index row = 0;
    for (int order = 0; order < 3; ++order) {
        for (Eigen::Index j = 0; j < robot_.model.dof; ++j) {
            const double limit = largest[static_cast<std::size_t>(order)][j];
            if (!std::isfinite(limit)) {
                continue;
            }
            const double centre = order == 0 ? limits.centre()[j] : 0.0;
            Eigen::ArrayXd weight;
            const Eigen::ArrayXd share = (signal(samples, order).col(j).array() - centre) / limit;
            value.constraints[row] = smooth_size(share, form.sharpness, weight) - 1.0;
            value.jacobian.col(row).segment(j * width_, width_) = scale_.col(j).cwiseProduct(
                basis_[static_cast<std::size_t>(order)].transpose() * (weight / limit).matrix());
            ++row;
        }
    }
}

void excitation_problem::add_boxes(const motion_samples& samples, const smoothing& form, problem_value& value) const {
    const auto count = static_cast<Eigen::Index>(t_.size());
    Eigen::Index row = constraints() - static_cast<Eigen::Index>(robot_.limits.boxes.size());
    for (const workspace_box& box : robot_.limits.boxes) {
        const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
        const Eigen::Vector3d half = 0.5 * (box.high - box.low);
        Eigen::ArrayXd share(3 * count);
        std::vector<Eigen::Matrix3Xd> slopes(static_cast<std::size_t>(count));
        for (Eigen::Index k = 0; k < count; ++k) {
            Eigen::Matrix3Xd& slope = slopes[static_cast<std::size_t>(k)];
            const Eigen::Vector3d place =
                point_of_link(robot_.links, box.link, box.point, samples.q.row(k).transpose(), &slope);
            share.segment<3>(3 * k) = (place - centre).cwiseQuotient(half).array();
            slope = half.cwiseInverse().asDiagonal() * slope;
        }
        Eigen::ArrayXd weight;
        value.constraints[row] = smooth_size(share, form.sharpness, weight) - 1.0;
        Eigen::MatrixXd by_position(count, robot_.model.dof);
        for (Eigen::Index k = 0; k < count; ++k) {
            by_position.row(k) = weight.segment<3>(3 * k).matrix().transpose() * slopes[static_cast<std::size_t>(k)];
        }
        value.jacobian.col(row) = scale_.cwiseProduct(basis_[0].transpose() * by_position).reshaped();
        ++row;
    }
}

void excitation_problem::add_model(const motion_samples& samples, const smoothing& form, problem_value& value) const {
    const Eigen::Index n = robot_.model.dof;
    const Eigen::Index b = robot_.model.n_base;
    const auto count = static_cast<double>(t_.size());
    const Eigen::MatrixXd W = sampled_regressor(robot_.model, samples);
    const gram_value criterion = this->criterion(W, form.power);
    value.objective = criterion.value;
    value.figure = criterion.figure;
    Eigen::MatrixXd by_W(W.rows(), W.cols());
    for (Eigen::Index i = 0; i < n; ++i) {
        by_W.middleCols(i * b, b) = (2.0 / count) * W.middleCols(i * b, b) * criterion.derivative;
    }
    const auto limited = static_cast<Eigen::Index>(torque_limited_.size());
    const Eigen::Index first_row = constraints() - limited - static_cast<Eigen::Index>(robot_.limits.boxes.size());
    Eigen::MatrixXd weights(W.rows(), limited);
    for (Eigen::Index c = 0; c < limited; ++c) {
        const Eigen::Index i = torque_limited_[static_cast<std::size_t>(c)];
        Eigen::ArrayXd weight;
        const Eigen::ArrayXd share = (W.middleCols(i * b, b) * robot_.chi).array() / robot_.limits.torque[i];
        value.constraints[first_row + c] = smooth_size(share, form.sharpness, weight) - 1.0;
        weights.col(c) = (weight / robot_.limits.torque[i]).matrix();
    }
    // Every signal of every joint by itself; each writes its own column.
    Eigen::MatrixXd objective_parts(width_, 3 * n);
    std::vector<Eigen::MatrixXd> torque_parts(static_cast<std::size_t>(3 * n));
    for_each_on_all_cores(static_cast<std::size_t>(3 * n), [&](std::size_t direction) {
        const auto order = static_cast<int>(direction % 3);
        const auto j = static_cast<Eigen::Index>(direction / 3);
        const Eigen::MatrixXd slope = regressor_derivative(robot_.model, samples, order, j);
        const Eigen::MatrixXd& basis = basis_[static_cast<std::size_t>(order)];
        const Eigen::VectorXd by_signal = by_W.cwiseProduct(slope).rowwise().sum();
        objective_parts.col(static_cast<Eigen::Index>(direction)) = basis.transpose() * by_signal;
        Eigen::MatrixXd by_torque(W.rows(), limited);
        for (Eigen::Index c = 0; c < limited; ++c) {
            const Eigen::Index i = torque_limited_[static_cast<std::size_t>(c)];
            by_torque.col(c) = weights.col(c).cwiseProduct(slope.middleCols(i * b, b) * robot_.chi);
        }
        torque_parts[direction] = basis.transpose() * by_torque;
    });
    for (Eigen::Index direction = 0; direction < 3 * n; ++direction) {
        const Eigen::Index j = direction / 3;
        value.gradient.segment(j * width_, width_) += scale_.col(j).cwiseProduct(objective_parts.col(direction));
        value.jacobian.block(j * width_, first_row, width_, limited) +=
            scale_.col(j).asDiagonal() * torque_parts[static_cast<std::size_t>(direction)];
    }
}

}  // namespace idim
