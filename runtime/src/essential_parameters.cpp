#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// Rows that count once the residual's correlation is taken off, sum_j rows_j / correlation_length_j, less the
/// parameters.
double effective_freedom(const observation& rows, const estimate& full) {
    double effective = 0.0;
    for (int j = 0; j < rows.dof; ++j) {
        effective += static_cast<double>(rows.rows(j)) / full.correlation_length[j];
    }
    return std::max(effective - static_cast<double>(rows.n_base), 1.0);
}

/// The full model under the constraint that chi is zero at `dropped`, without another pass over the rows: the estimate
/// nearest to the full one in the metric of its covariance C [Seber and Lee 2003, section 3.8, with C for sigma^2
/// (W'W)^-1],
///     chi - C_D C_DD^-1 chi_D,    C - C_D C_DD^-1 C_D',    F = chi_D' C_DD^-1 chi_D / k.
/// With C = sigma^2 (W'W)^-1, F is the classic ratio of the growth of the squared residual to the residual; with the
/// robust C it stays an F statistic when the residual is correlated, which that ratio does not.
struct constrained {
    Eigen::VectorXd chi;
    Eigen::VectorXd variance;
    double f_statistic = 0.0;
};

constrained constrain(const estimate& full, const std::vector<int>& dropped) {
    if (dropped.empty()) {
        return {full.chi, full.covariance.diagonal(), 0.0};
    }
    const Eigen::VectorXd deviation = full.deviations()(dropped);
    const Eigen::VectorXd chi = full.chi(dropped);
    if (((deviation.array() == 0.0) && (chi.array() != 0.0)).any()) {
        return {full.chi, full.covariance.diagonal(), std::numeric_limits<double>::max()};
    }
    const Eigen::VectorXd scale = (deviation.array() > 0.0).select(deviation.cwiseInverse(), 0.0);
    const Eigen::MatrixXd correlation = scale.asDiagonal() * full.covariance(dropped, dropped) * scale.asDiagonal();
    const Eigen::MatrixXd C_D = full.covariance(Eigen::all, dropped) * scale.asDiagonal();
    const Eigen::LDLT<Eigen::MatrixXd> factor(correlation);
    const Eigen::VectorXd t = scale.cwiseProduct(chi);
    const Eigen::VectorXd solved = factor.solve(t);
    return {full.chi - C_D * solved,
            full.covariance.diagonal() - C_D.cwiseProduct(factor.solve(C_D.transpose()).transpose()).rowwise().sum(),
            t.dot(solved) / static_cast<double>(dropped.size())};
}

double p_value_of(double f, std::size_t dropped, double freedom) {
    const boost::math::fisher_f distribution(static_cast<double>(dropped), freedom);
    return boost::math::cdf(boost::math::complement(distribution, f));
}

/// The rows of a model that has only the columns `kept`.
observation with_columns(const observation& rows, const std::vector<int>& kept) {
    observation reduced;
    reduced.dof = rows.dof;
    reduced.n_base = static_cast<int>(kept.size());
    for (const observation_block& block : rows.blocks) {
        observation_block columns{block.file, block.rate, block.t, block.kept, {}, block.Y};
        for (const Eigen::MatrixXd& W : block.W) {
            columns.W.push_back(W(Eigen::all, kept));
        }
        reduced.blocks.push_back(std::move(columns));
    }
    return reduced;
}

/// Position in `kept` of the largest relative deviation [IV 19].
std::size_t least_certain(const constrained& fit, const std::vector<int>& kept) {
    std::size_t worst = 0;
    double largest = -1.0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const double size = std::abs(fit.chi[kept[i]]);
        const double deviation = std::sqrt(std::max(fit.variance[kept[i]], 0.0));
        const double ratio = size > 0.0 ? deviation / size : std::numeric_limits<double>::infinity();
        if (ratio > largest) {
            largest = ratio;
            worst = i;
        }
    }
    return worst;
}

}  // namespace

essential_parameters find_essential(const observation& rows, const estimate& full, double significance) {
    if (full.chi.size() != rows.n_base) {
        throw data_error("essential parameters need a full model: " + full.message);
    }
    const double freedom = effective_freedom(rows, full);
    essential_parameters result;
    for (int c = 0; c < rows.n_base; ++c) {
        result.kept.push_back(c);
    }
    constrained reduced = constrain(full, {});
    while (!result.kept.empty()) {
        const auto candidate = result.kept.begin() + static_cast<std::ptrdiff_t>(least_certain(reduced, result.kept));
        std::vector<int> dropped = result.dropped;
        dropped.push_back(*candidate);
        constrained next = constrain(full, dropped);
        const double p = p_value_of(next.f_statistic, dropped.size(), freedom);
        if (p <= significance) {
            break;
        }
        reduced = std::move(next);
        result.f_statistic = reduced.f_statistic;
        result.p_value = p;
        result.dropped = std::move(dropped);
        result.kept.erase(candidate);
    }
    result.chi = Eigen::VectorXd::Zero(rows.n_base);
    result.std = Eigen::VectorXd::Zero(rows.n_base);
    if (!result.kept.empty()) {
        const estimate refit = weighted_fit(with_columns(rows, result.kept), weights_of(full.joint_deviation));
        result.chi(result.kept) = refit.chi;
        result.std(result.kept) = refit.deviations();
    }
    result.residual = errors(rows, result.chi);
    return result;
}

}  // namespace idim
