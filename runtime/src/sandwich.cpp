#include "sandwich.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "idim/autocorrelation.hpp"
#include "lag_moments.hpp"
#include "parallel.hpp"

namespace idim {

namespace {

constexpr int bias_corrections = 2;

// All of this works on the uniform grid of the samples of every log, with zeros where rows were left out: the noise
// goes on through a gap, what stands on its two sides stays as correlated as its distance in time says, and the rows of
// different joints at one instant stand side by side.

/// V with M = VV' of a positive semi-definite M, eigenvalues that rounding made negative taken as zero.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& M) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(M);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The orthonormal columns Q of the weighted rows, W R^-1 where these are least squares'.
class orthonormal_rows {
  public:
    orthonormal_rows(const row_source& rows, const std::vector<double>& joint_weight, const Eigen::MatrixXd& inverse)
        : rows_(rows), weight_(joint_weight), inverse_(inverse) {}

    std::size_t joints() const { return weight_.size(); }
    Eigen::Index columns() const { return inverse_.cols(); }
    std::size_t logs() const { return rows_.logs(); }
    Eigen::Index rows(std::size_t joint) const { return rows_.rows(static_cast<int>(joint)); }

    /// Calls `use` with every part and joint; joints on several cores where that is worth it.
    void visit(Eigen::Index margin, const std::function<void(const row_part&, std::size_t joint)>& use) const {
        constexpr Eigen::Index many = 4096;
        rows_.visit(margin, [&](const row_part& part) {
            if (part.count >= many) {
                for_each_on_all_cores(joints(), [&](std::size_t j) { use(part, j); });
                return;
            }
            for (std::size_t j = 0; j < joints(); ++j) {
                use(part, j);
            }
        });
    }

    void visit_parts(Eigen::Index margin, const std::function<void(const row_part&)>& use) const {
        rows_.visit(margin, use);
    }

    /// Q of one joint at all samples of the part's block.
    Eigen::MatrixXd of(const row_part& part, std::size_t joint) const {
        return on_grid(part.block, joint, weight_[joint] * (part.block.W[joint] * inverse_));
    }

  private:
    const row_source& rows_;
    const std::vector<double>& weight_;
    const Eigen::MatrixXd& inverse_;
};

/// Rows of the innovations before the first sample of a part's block that its rows still feel.
Eigen::Index tail_of(const row_part& part, const autoregression& model) {
    return part.begins_log ? model.memory(part.reach) : 0;
}

/// Those of the part itself among responses with so many before the block, [first, count].
std::pair<Eigen::Index, Eigen::Index> own_responses(const row_part& part, Eigen::Index tail) {
    return part.first == 0 ? std::pair(Eigen::Index{0}, tail + part.count) : std::pair(tail + part.first, part.count);
}

/// Samples around a part that its sums need to 1e-12.
Eigen::Index margin_of(const std::vector<autoregression>& models, Eigen::Index lags) {
    constexpr Eigen::Index longest = Eigen::Index{1} << 14;
    Eigen::Index memory = 0;
    for (const autoregression& model : models) {
        memory = std::max(memory, model.memory(longest, 1e-12));
    }
    return memory + lags;
}

/// Sums over the rows of one joint that the model of its noise gives: Q' Gamma Q, and tr(Q' D_l P Gamma Q) at lags
/// 0..lags with D_l the symmetric shift by l and P the rows present.
struct model_sums {
    Eigen::MatrixXd meat;
    Eigen::VectorXd shifted;
};

void add_sums(const row_part& part, std::size_t joint, const Eigen::MatrixXd& Q, const autoregression& model,
              model_sums& sums) {
    const Eigen::Index tail = tail_of(part, model);
    const Eigen::MatrixXd Z = innovation_responses(model, Q, tail);
    const auto [from, count] = own_responses(part, tail);
    sums.meat.selfadjointView<Eigen::Lower>().rankUpdate(Z.middleRows(from, count).transpose(), model.innovation);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(part.block.W[joint].rows());
    const Eigen::VectorXd present = on_grid(part.block, joint, ones);
    const Eigen::MatrixXd G = present.asDiagonal() * covariance_times(model, Z, Q.rows());
    const Eigen::Index lags = sums.shifted.size() - 1;
    sums.shifted += 0.25 * (lagged_products(Q + G, lags, part.first, part.count) -
                            lagged_products(Q - G, lags, part.first, part.count));
}

/// The residual's products, joint by joint.
std::vector<lag_moments> moments_of(const orthonormal_rows& Q, const series_source& residual) {
    std::vector<lag_moments> moments;
    for (std::size_t j = 0; j < Q.joints(); ++j) {
        moments.emplace_back(highest_order(Q.rows(j), Q.logs()));
    }
    residual.visit([&](const std::vector<gapped_series>& joints, bool begins) {
        for (std::size_t j = 0; j < joints.size(); ++j) {
            if (begins) {
                moments[j].begin_segment();
            }
            moments[j].add(joints[j]);
        }
    });
    return moments;
}

/// One correction of the models for what the fit has taken away, `raw` the autocovariances of the residual.
std::vector<autoregression> corrected_models(const orthonormal_rows& Q, const std::vector<lag_moments>& moments,
                                             const std::vector<Eigen::VectorXd>& raw,
                                             const std::vector<autoregression>& models) {
    const std::size_t joints = models.size();
    Eigen::Index lags = 0;
    std::vector<model_sums> sums;
    std::vector<Eigen::VectorXd> taken;
    for (const Eigen::VectorXd& gamma : raw) {
        lags = std::max(lags, gamma.size() - 1);
        sums.push_back({Eigen::MatrixXd::Zero(Q.columns(), Q.columns()), Eigen::VectorXd::Zero(gamma.size())});
        taken.emplace_back(Eigen::VectorXd::Zero(gamma.size()));
    }
    Q.visit(margin_of(models, lags),
            [&](const row_part& part, std::size_t j) { add_sums(part, j, Q.of(part, j), models[j], sums[j]); });
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(Q.columns(), Q.columns());
    for (const model_sums& of_joint : sums) {
        S += of_joint.meat.selfadjointView<Eigen::Lower>();
    }
    const Eigen::MatrixXd root = root_of(S);
    Q.visit(lags, [&](const row_part& part, std::size_t j) {
        taken[j] -= lagged_products(Q.of(part, j) * root, taken[j].size() - 1, part.first, part.count);
    });
    std::vector<autoregression> better;
    for (std::size_t j = 0; j < joints; ++j) {
        taken[j] += 2.0 * sums[j].shifted;
        // No pairs at all: nothing was taken either.
        const Eigen::VectorXd pairs = moments[j].pairs().cwiseMax(1.0);
        better.push_back(fit_autoregression(raw[j] + taken[j].cwiseQuotient(pairs), moments[j].samples()));
    }
    return better;
}

/// Models of the noise from the residual's autocovariance, corrected for what the fit has taken away. With
/// e = (P - QQ') rho and S = sum_j Q_j' Gamma_j Q_j, the products of joint j at lag l have the expectation
///     pairs(l) gamma_j(l) - 2 tr(Q_j' D_l P_j Gamma_j Q_j) + tr(D_l Q_j S Q_j').
std::vector<autoregression> noise_models(const orthonormal_rows& Q, const std::vector<lag_moments>& moments) {
    std::vector<Eigen::VectorXd> raw;
    std::vector<autoregression> models;
    for (const lag_moments& of_joint : moments) {
        raw.push_back(of_joint.autocovariance());
        models.push_back(fit_autoregression(raw.back(), of_joint.samples()));
    }
    for (int pass = 0; pass < bias_corrections; ++pass) {
        models = corrected_models(Q, moments, raw, models);
    }
    return models;
}

/// Correlation of the innovations of every two joints, over the samples that both have [n x n].
Eigen::MatrixXd innovation_correlation(const std::vector<autoregression>& models, const series_source& residual) {
    const auto n = static_cast<Eigen::Index>(models.size());
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd power = products;  // of the row's joint, where the column's is present too
    std::vector<innovation_filter> filters(models.begin(), models.end());
    Eigen::Index place = 0;  // of the piece in its log
    residual.visit([&](const std::vector<gapped_series>& joints, bool begins) {
        place = begins ? 0 : place;
        Eigen::MatrixXd eps(joints.front().value.size(), n);
        Eigen::MatrixXd present = eps;
        for (Eigen::Index j = 0; j < n; ++j) {
            const auto joint = static_cast<std::size_t>(j);
            if (begins) {
                filters[joint].begin_segment();
            }
            eps.col(j) = filters[joint].next(joints[joint]);
            present.col(j) = joints[joint].present;
            const Eigen::Index without_past = models[joint].order() - place;
            present.col(j).head(std::clamp(without_past, Eigen::Index{0}, eps.rows())).setZero();
        }
        products += eps.transpose() * eps;
        power += eps.cwiseAbs2().transpose() * present;
        place += eps.rows();
    });
    const Eigen::ArrayXXd norm = (power.array() * power.transpose().array()).sqrt();
    Eigen::MatrixXd correlation = (norm > 0.0).select(products.array() / norm, 0.0);
    correlation.diagonal().setOnes();
    return correlation;
}

/// Root of the covariance of the joints' innovations: diagonal from the models, correlation from the innovations
/// themselves.
Eigen::MatrixXd innovation_root(const std::vector<autoregression>& models, const series_source& residual) {
    Eigen::VectorXd deviation(static_cast<Eigen::Index>(models.size()));
    for (Eigen::Index j = 0; j < deviation.size(); ++j) {
        deviation[j] = std::sqrt(models[static_cast<std::size_t>(j)].innovation);
    }
    return root_of(deviation.asDiagonal() * innovation_correlation(models, residual) * deviation.asDiagonal());
}

/// Adds sum_m (sum_j z_jm root_ji) (...)' of one part: the variance of Q' rho that the innovations of all joints make
/// together.
void add_meat(const orthonormal_rows& Q, const row_part& part, const std::vector<autoregression>& models,
              const Eigen::MatrixXd& root, Eigen::MatrixXd& meat) {
    Eigen::Index tail = 0;
    for (const autoregression& model : models) {
        tail = std::max(tail, tail_of(part, model));
    }
    const auto [from, count] = own_responses(part, tail);
    std::vector<Eigen::MatrixXd> responses;
    for (std::size_t j = 0; j < models.size(); ++j) {
        responses.emplace_back(innovation_responses(models[j], Q.of(part, j), tail).middleRows(from, count));
    }
    for (Eigen::Index i = 0; i < root.cols(); ++i) {
        Eigen::MatrixXd U = Eigen::MatrixXd::Zero(count, meat.cols());
        for (std::size_t j = 0; j < models.size(); ++j) {
            U += root(static_cast<Eigen::Index>(j), i) * responses[j];
        }
        meat.selfadjointView<Eigen::Lower>().rankUpdate(U.transpose());
    }
}

}  // namespace

sandwich robust_covariance(const observation& rows, const std::vector<double>& joint_weight, const stacked_qr& qr,
                           const joint_series& residual) {
    const Eigen::MatrixXd inverse = qr.inverse();
    return robust_covariance(rows, joint_weight, inverse, inverse, residual);
}

sandwich robust_covariance(const observation& instruments, const std::vector<double>& joint_weight,
                           const Eigen::MatrixXd& instrument_inverse, const Eigen::MatrixXd& to_parameters,
                           const joint_series& residual) {
    return robust_covariance(resident_rows(instruments), joint_weight, instrument_inverse, to_parameters,
                             resident_series(instruments, residual));
}

sandwich robust_covariance(const row_source& instruments, const std::vector<double>& joint_weight,
                           const Eigen::MatrixXd& instrument_inverse, const Eigen::MatrixXd& to_parameters,
                           const series_source& residual) {
    const orthonormal_rows Q(instruments, joint_weight, instrument_inverse);
    const std::vector<lag_moments> moments = moments_of(Q, residual);
    const std::vector<autoregression> models = noise_models(Q, moments);
    const Eigen::MatrixXd root = innovation_root(models, residual);
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(Q.columns(), Q.columns());
    Q.visit_parts(margin_of(models, 0), [&](const row_part& part) { add_meat(Q, part, models, root, meat); });
    const Eigen::MatrixXd half = to_parameters * root_of(meat.selfadjointView<Eigen::Lower>());
    sandwich result;
    result.covariance = half * half.transpose();
    for (std::size_t j = 0; j < models.size(); ++j) {
        result.correlation_length.push_back(models[j].correlation_length(moments[j].samples()));
    }
    return result;
}

}  // namespace idim
