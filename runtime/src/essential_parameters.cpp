#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// Rows that count once the residual's correlation is taken off, sum_j rows_j / correlation_length_j, less the
/// parameters.
double effective_freedom(const joint_triangles& joints, const estimate& full) {
    double effective = 0.0;
    for (int j = 0; j < joints.joints(); ++j) {
        effective += static_cast<double>(joints.rows(j)) / full.correlation_length[static_cast<std::size_t>(j)];
    }
    return std::max(effective - static_cast<double>(joints.columns()), 1.0);
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

/// Rows of which a model has only some columns.
class fewer_columns : public row_source {
  public:
    fewer_columns(const row_source& rows, const std::vector<int>& kept) : rows_(rows), kept_(kept) {}

    int dof() const override { return rows_.dof(); }
    int n_base() const override { return static_cast<int>(kept_.size()); }
    std::size_t logs() const override { return rows_.logs(); }
    Eigen::Index rows(int joint) const override { return rows_.rows(joint); }
    void visit(Eigen::Index margin, const std::function<void(const row_part&)>& use) const override {
        rows_.visit(margin, [&](const row_part& part) {
            observation_block block{part.block.file, part.block.rate, part.block.t, part.block.kept, {}, part.block.Y};
            for (const Eigen::MatrixXd& W : part.block.W) {
                block.W.emplace_back(W(Eigen::all, kept_));
            }
            use({block, part.first, part.count, part.reach, part.begins_log});
        });
    }
    std::unique_ptr<series_source> residual(const Eigen::VectorXd& chi,
                                            const std::vector<double>& joint_weight) const override {
        Eigen::VectorXd all = Eigen::VectorXd::Zero(rows_.n_base());
        all(kept_) = chi;
        return rows_.residual(all, joint_weight);
    }

  private:
    const row_source& rows_;
    const std::vector<int>& kept_;
};

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

essential_parameters find_essential(const row_source& rows, const joint_triangles& joints, const estimate& full,
                                    double significance) {
    if (full.chi.size() != rows.n_base()) {
        throw data_error("essential parameters need a full model: " + full.message);
    }
    const double freedom = effective_freedom(joints, full);
    essential_parameters result;
    for (int c = 0; c < rows.n_base(); ++c) {
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
    result.chi = Eigen::VectorXd::Zero(rows.n_base());
    result.std = Eigen::VectorXd::Zero(rows.n_base());
    if (!result.kept.empty()) {
        const estimate refit = weighted_fit(fewer_columns(rows, result.kept), joints.with_columns(result.kept),
                                            weights_of(full.joint_deviation));
        result.chi(result.kept) = refit.chi;
        result.std(result.kept) = refit.deviations();
    }
    result.residual = errors(joints, result.chi);
    return result;
}

essential_parameters find_essential(const observation& rows, const estimate& full, double significance) {
    essential_parameters result = find_essential(resident_rows(rows), triangles_of(rows), full, significance);
    result.residual = errors(rows, result.chi);  // to the last digit, where the rows are at hand
    return result;
}

}  // namespace idim
