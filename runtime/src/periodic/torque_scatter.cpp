#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "idim/zero_phase_filter.hpp"
#include "periodic/folded_period.hpp"

namespace idim {

namespace {

constexpr double smallest_scatter = 1e-9;  // of the torque
constexpr double smallest_joint = 1e-6;    // of the largest joint's, as in weights_of

/// Torque of one period less its average, decimated on the rows of the average; the neighbouring periods lead the
/// filter in and out where there are any.
Eigen::MatrixXd deviation_of(const motion_source& motion, const Eigen::MatrixXd& mean, Eigen::Index p,
                             const periodic_part& part, const filter_choice& choice) {
    const Eigen::Index margin = period_margin(choice);
    const Eigen::Index before = p * part.period;
    const Eigen::Index lead = std::min(margin, before / choice.decimation * choice.decimation);
    const Eigen::Index tail = std::min(margin, (part.periods - 1 - p) * part.period);
    Eigen::MatrixXd around = motion.part(part.first + before - lead, lead + part.period + tail).tau;
    for (Eigen::Index k = 0; k < around.rows(); ++k) {
        around.row(k) -= mean.row((before - lead + k) % part.period);
    }
    return decimate(around, choice.decimation).middleRows(lead / choice.decimation, rows_in_period(part, choice));
}

std::vector<Eigen::MatrixXd> deviations_of(const motion_source& motion, const Eigen::MatrixXd& mean,
                                           const periodic_part& part, const filter_choice& choice) {
    std::vector<Eigen::MatrixXd> periods;
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(rows_in_period(part, choice), mean.cols());
    for (Eigen::Index p = 0; p < part.periods; ++p) {
        periods.push_back(deviation_of(motion, mean, p, part, choice));
        left += periods.back();
    }
    // The ends of the first and the last period are filtered otherwise than those of the others.
    for (Eigen::MatrixXd& period : periods) {
        period -= left / static_cast<double>(part.periods);
    }
    return periods;
}

/// S_k of [CWLS 11] for every row.
std::vector<Eigen::MatrixXd> covariances_of(const std::vector<Eigen::MatrixXd>& deviations) {
    const Eigen::Index n = deviations.front().cols();
    std::vector<Eigen::MatrixXd> S(static_cast<std::size_t>(deviations.front().rows()), Eigen::MatrixXd::Zero(n, n));
    for (std::size_t k = 0; k < S.size(); ++k) {
        for (const Eigen::MatrixXd& period : deviations) {
            const Eigen::VectorXd d = period.row(static_cast<Eigen::Index>(k));
            S[k] += d * d.transpose();
        }
        S[k] /= static_cast<double>(deviations.size() - 1);
    }
    return S;
}

/// lambda of scatter_of. In the metric of the mean, with v = P - 1 degrees of freedom and Sigma the covariance of a
/// row,
///     E |S - Sigma|^2 = (tr(Sigma)^2 + tr(Sigma^2)) / v,
/// and both traces follow from E tr(S)^2 = tr(Sigma)^2 + 2 tr(Sigma^2) / v and
/// E tr(S^2) = tr(Sigma^2) (1 + 1 / v) + tr(Sigma)^2 / v.
double pooled_share_of(const std::vector<Eigen::MatrixXd>& S, const Eigen::MatrixXd& pooled, std::size_t periods) {
    const auto n = static_cast<double>(pooled.rows());
    const auto v = static_cast<double>(periods - 1);
    const Eigen::LLT<Eigen::MatrixXd> root(pooled);
    double spread = 0.0;
    double squared_trace = 0.0;
    double trace_of_square = 0.0;
    for (const Eigen::MatrixXd& each : S) {
        const Eigen::MatrixXd half = root.matrixL().solve(each);
        const Eigen::MatrixXd M = root.matrixL().solve(half.transpose());
        spread += (M - Eigen::MatrixXd::Identity(M.rows(), M.cols())).squaredNorm();
        squared_trace += M.trace() * M.trace();
        trace_of_square += M.squaredNorm();
    }
    const double determinant = 1.0 + 1.0 / v - 2.0 / (v * v);
    const double of_square =
        determinant > 0.0 ? (trace_of_square - squared_trace / v) / determinant : trace_of_square / (1.0 + 1.0 / v);
    const double noise = std::max(squared_trace - 2.0 * of_square / v, 0.0) / v + std::max(of_square, 0.0) / v;
    const double least = (n + 2.0) / (v + n + 2.0);
    return std::clamp(spread > 0.0 ? noise / spread : 1.0, least, 1.0);
}

/// Covariances from the deviations.
void fill_covariance(torque_scatter& scatter) {
    scatter.covariance = covariances_of(scatter.deviations);
    const Eigen::Index n = scatter.deviations.front().cols();
    Eigen::MatrixXd pooled = Eigen::MatrixXd::Zero(n, n);
    for (const Eigen::MatrixXd& S : scatter.covariance) {
        pooled += S / static_cast<double>(scatter.covariance.size());
    }
    scatter.rms = pooled.diagonal().cwiseSqrt();
    if (scatter.rms.maxCoeff() == 0.0) {
        return;
    }
    // A joint without torque has no scatter; it must not make the weights of the others vanish.
    const double floor = smallest_joint * scatter.rms.maxCoeff();
    pooled.diagonal().array() += floor * floor;
    scatter.pooled_share = pooled_share_of(scatter.covariance, pooled, scatter.deviations.size());
    for (Eigen::MatrixXd& S : scatter.covariance) {
        S = (1.0 - scatter.pooled_share) * S + scatter.pooled_share * pooled;
    }
}

}  // namespace

torque_scatter scatter_of(const motion_source& motion, const periodic_part& part, const filter_choice& choice) {
    const Eigen::MatrixXd mean = mean_period(motion, part).tau;
    torque_scatter scatter;
    scatter.deviations = deviations_of(motion, mean, part, choice);
    fill_covariance(scatter);
    const Eigen::VectorXd size = mean.cwiseAbs().colwise().maxCoeff();
    scatter.scatters = (scatter.rms.array() > smallest_scatter * size.array()).any();
    return scatter;
}

torque_scatter scatter_of(const filtered_samples& samples, const periodic_part& part, const filter_choice& choice) {
    return scatter_of(resident_motion(samples), part, choice);
}

torque_scatter without_period(torque_scatter scatter, std::size_t p) {
    const Eigen::MatrixXd out = scatter.deviations[p] / static_cast<double>(scatter.deviations.size() - 1);
    scatter.deviations.erase(scatter.deviations.begin() + static_cast<std::ptrdiff_t>(p));
    for (Eigen::MatrixXd& period : scatter.deviations) {
        period += out;  // about the average of those that are left
    }
    fill_covariance(scatter);
    return scatter;
}

}  // namespace idim
