#include "trace_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

namespace idim {

namespace {

constexpr double excited = 1e-8;  ///< singular values below this part of the largest are taken as not excited
constexpr int noise_passes = 3;

/// Square triangle of A below what was factored before.
Eigen::MatrixXd folded(const Eigen::MatrixXd& triangle, const Eigen::MatrixXd& A) {
    Eigen::MatrixXd stacked(triangle.rows() + A.rows(), A.cols());
    stacked << triangle, A;
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stacked);
    const Eigen::Index height = std::min(stacked.rows(), stacked.cols());
    return stacked.topRows(height).triangularView<Eigen::Upper>();
}

Eigen::VectorXd weights_of(const traced_log& log, int joint, const row_noise& noise) {
    const row_flags& reversal = log.reversal[static_cast<std::size_t>(joint)];
    return reversal.select(Eigen::ArrayXd::Constant(reversal.size(), 1.0 / noise.reversal[joint]),
                           Eigen::ArrayXd::Constant(reversal.size(), 1.0 / noise.moving[joint]));
}

bool is_known(const effect_candidate& candidate) {
    return candidate.linear.size() == 1 && candidate.linear.front().is_one;
}

Eigen::Index width(const effect_term& term, const std::vector<traced_log>& logs) {
    const auto m = static_cast<Eigen::Index>(term.candidate->linear.size());
    return term.candidate->per_log ? m * static_cast<Eigen::Index>(logs.size()) : m;
}

}  // namespace

trace_fit::trace_fit(const std::vector<traced_log>& logs, std::vector<effect_term> terms, row_noise noise)
    : logs_(&logs), terms_(std::move(terms)), noise_(std::move(noise)) {
    build_columns();
    solve();
}

void trace_fit::build_columns() {
    base_ = logs_->front().rows.W.front().cols();
    Eigen::Index total = base_;
    for (const effect_term& term : terms_) {
        first_.push_back(total);
        total += width(term, *logs_);
    }
    columns_.resize(logs_->size());
    weight_.resize(logs_->size());
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        const traced_log& log = (*logs_)[l];
        for (std::size_t j = 0; j < log.rows.W.size(); ++j) {
            const Eigen::MatrixXd& W = log.rows.W[j];
            Eigen::MatrixXd all = Eigen::MatrixXd::Zero(W.rows(), total);
            all.leftCols(base_) = W;
            columns_[l].push_back(std::move(all));
            weight_[l].push_back(weights_of(log, static_cast<int>(j), noise_));
        }
        for (std::size_t i = 0; i < terms_.size(); ++i) {
            const effect_candidate& candidate = *terms_[i].candidate;
            const auto m = static_cast<Eigen::Index>(candidate.linear.size());
            const Eigen::Index place = first_[i] + (candidate.per_log ? m * static_cast<Eigen::Index>(l) : 0);
            const std::vector<Eigen::MatrixXd> X = candidate.touched_rows(log, terms_[i].shape);
            for (std::size_t k = 0; k < X.size(); ++k) {
                columns_[l][static_cast<std::size_t>(candidate.touched[k])].middleCols(place, m) = X[k];
            }
        }
    }
}

Eigen::VectorXd trace_fit::known_coefficients() const {
    Eigen::VectorXd known = Eigen::VectorXd::Zero(columns_.front().front().cols());
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        known[first_[i]] = is_known(*terms_[i].candidate) ? 1.0 : 0.0;
    }
    return known;
}

void trace_fit::solve() {
    const Eigen::Index p = columns_.front().front().cols();
    const Eigen::VectorXd known = known_coefficients();
    const Eigen::VectorXd fitted = Eigen::VectorXd::Ones(p) - known;
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(0, p + 1);
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        for (std::size_t j = 0; j < columns_[l].size() && !(*logs_)[l].held_back; ++j) {
            Eigen::MatrixXd A(columns_[l][j].rows(), p + 1);
            A << columns_[l][j] * fitted.asDiagonal(), (*logs_)[l].rows.Y[j] - columns_[l][j] * known;
            triangle = folded(triangle, weight_[l][j].asDiagonal() * A);
        }
    }
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(p, p + 1);
    R.topRows(std::min(p, triangle.rows())) = triangle.topRows(std::min(p, triangle.rows()));
    Eigen::VectorXd norm = R.leftCols(p).colwise().norm();
    norm = (norm.array() > 0.0).select(norm, 1.0);
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(R.leftCols(p) * norm.cwiseInverse().asDiagonal(),
                                             Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd& s = svd.singularValues();
    const Eigen::Index rank = (s.array() > excited * s[0]).count();
    basis_scale_ =
        norm.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) * s.head(rank).cwiseInverse().asDiagonal();
    all_ = basis_scale_ * (svd.matrixU().leftCols(rank).transpose() * R.col(p)) + known;
    basis_.resize(logs_->size());
    residual_.resize(logs_->size());
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        for (std::size_t j = 0; j < columns_[l].size(); ++j) {
            if (!(*logs_)[l].held_back) {
                basis_[l].emplace_back((weight_[l][j].asDiagonal() * columns_[l][j]) * basis_scale_);
            }
            residual_[l].emplace_back((*logs_)[l].rows.Y[j] - columns_[l][j] * all_);
        }
    }
    refit_per_log_terms();
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        for (std::size_t j = 0; j < residual_[l].size() && !(*logs_)[l].held_back; ++j) {
            loss_ += residual_[l][j].cwiseProduct(weight_[l][j]).squaredNorm();
        }
    }
}

/// The phase of a periodic disturbance is each log's own: in a log held back it is fitted there, all else is not.
void trace_fit::refit_per_log_terms() {
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        for (std::size_t i = 0; i < terms_.size() && (*logs_)[l].held_back; ++i) {
            if (!terms_[i].candidate->per_log) {
                continue;
            }
            const auto m = static_cast<Eigen::Index>(terms_[i].candidate->linear.size());
            const Eigen::Index place = first_[i] + m * static_cast<Eigen::Index>(l);
            for (const int j : terms_[i].candidate->touched) {
                const auto joint = static_cast<std::size_t>(j);
                const Eigen::MatrixXd X = weight_[l][joint].asDiagonal() * columns_[l][joint].middleCols(place, m);
                const Eigen::VectorXd a =
                    X.colPivHouseholderQr().solve(weight_[l][joint].cwiseProduct(residual_[l][joint]));
                residual_[l][joint] -= columns_[l][joint].middleCols(place, m) * a;
            }
        }
    }
}

Eigen::VectorXd trace_fit::coefficients(std::size_t term) const {
    return all_.segment(first_[term], static_cast<Eigen::Index>(terms_[term].candidate->linear.size()));
}

projected_columns trace_fit::project(const effect_candidate& candidate, const Eigen::VectorXd& shape,
                                     bool quick) const {
    const auto m = static_cast<Eigen::Index>(candidate.linear.size());
    const Eigen::Index logs = candidate.per_log ? static_cast<Eigen::Index>(logs_->size()) : 1;
    projected_columns found;
    found.touched = candidate.touched;
    found.on_basis = Eigen::MatrixXd::Zero(basis_scale_.cols(), m * logs);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(m * logs, m * logs);
    Eigen::VectorXd on_residual = Eigen::VectorXd::Zero(m * logs);
    found.weighted.resize(logs_->size());
    for (std::size_t l = 0; l < logs_->size(); ++l) {
        if ((*logs_)[l].held_back) {
            continue;
        }
        const Eigen::Index place = candidate.per_log ? m * static_cast<Eigen::Index>(l) : 0;
        std::vector<Eigen::MatrixXd> exact;
        if (!quick) {
            exact = candidate.touched_rows((*logs_)[l], shape);
        }
        for (std::size_t k = 0; k < candidate.touched.size(); ++k) {
            const auto joint = static_cast<std::size_t>(candidate.touched[k]);
            Eigen::MatrixXd X =
                quick ? candidate.quick_rows((*logs_)[l], candidate.touched[k], shape) : std::move(exact[k]);
            X = weight_[l][joint].asDiagonal() * X;
            found.on_basis.middleCols(place, m) += basis_[l][joint].transpose() * X;
            gram.block(place, place, m, m) += X.transpose() * X;
            on_residual.segment(place, m) += X.transpose() * residual_[l][joint].cwiseProduct(weight_[l][joint]);
            found.weighted[l].push_back(std::move(X));
        }
    }
    found.scale = gram.diagonal().cwiseSqrt();
    const Eigen::VectorXd inverse = (found.scale.array() > 0.0).select(found.scale.cwiseInverse(), 0.0);
    const Eigen::MatrixXd outside =
        inverse.asDiagonal() * (gram - found.on_basis.transpose() * found.on_basis) * inverse.asDiagonal();
    if (is_known(candidate)) {
        found.rank = outside(0, 0) > candidate.least_outside * candidate.least_outside ? 1 : 0;
        found.coefficient = Eigen::VectorXd::Ones(1);
        found.gain = 2.0 * on_residual[0] - outside(0, 0) * found.scale[0] * found.scale[0];
        return found;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(outside);
    const Eigen::VectorXd g = eigen.eigenvectors().transpose() * (inverse.asDiagonal() * on_residual);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(g.size());
    for (Eigen::Index i = 0; i < g.size(); ++i) {
        if (eigen.eigenvalues()[i] > candidate.least_outside * candidate.least_outside) {
            along[i] = g[i] / eigen.eigenvalues()[i];
            found.gain += g[i] * along[i];
            ++found.rank;
        }
    }
    found.coefficient = inverse.asDiagonal() * (eigen.eigenvectors() * along);
    return found;
}

std::vector<Eigen::VectorXd> trace_fit::residual_with(const effect_candidate& candidate, const Eigen::VectorXd& shape,
                                                      const projected_columns& columns, std::size_t log) const {
    const auto m = static_cast<Eigen::Index>(candidate.linear.size());
    const Eigen::VectorXd moved = basis_scale_ * (columns.on_basis * columns.coefficient);
    std::vector<Eigen::VectorXd> left;
    for (std::size_t j = 0; j < residual_[log].size(); ++j) {
        left.emplace_back(residual_[log][j] + columns_[log][j] * moved);
    }
    const std::vector<Eigen::MatrixXd> rows = candidate.touched_rows((*logs_)[log], shape);
    const Eigen::Index place = candidate.per_log ? m * static_cast<Eigen::Index>(log) : 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto j = static_cast<std::size_t>(candidate.touched[k]);
        Eigen::VectorXd coefficient;
        if (candidate.per_log && (*logs_)[log].held_back) {
            const Eigen::MatrixXd weighted = weight_[log][j].asDiagonal() * rows[k];
            coefficient = weighted.colPivHouseholderQr().solve(weight_[log][j].cwiseProduct(left[j]));
        } else {
            coefficient = columns.coefficient.segment(place, m);
        }
        left[j] -= rows[k] * coefficient;
    }
    return left;
}

row_noise trace_fit::estimated_noise() const {
    const auto joints = static_cast<Eigen::Index>(residual_.front().size());
    row_noise noise{Eigen::VectorXd::Zero(joints), Eigen::VectorXd::Zero(joints)};
    double largest = 0.0;
    for (Eigen::Index j = 0; j < joints; ++j) {
        double moving = 0.0;
        double reversal = 0.0;
        double moving_rows = 0.0;
        double reversal_rows = 0.0;
        for (std::size_t l = 0; l < logs_->size(); ++l) {
            if ((*logs_)[l].held_back) {
                continue;
            }
            const row_flags& flags = (*logs_)[l].reversal[static_cast<std::size_t>(j)];
            const Eigen::ArrayXd squared = residual_[l][static_cast<std::size_t>(j)].array().square();
            const double at_reversal = flags.select(squared, 0.0).sum();
            reversal += at_reversal;
            moving += squared.sum() - at_reversal;
            reversal_rows += static_cast<double>(flags.count());
            moving_rows += static_cast<double>(flags.size() - flags.count());
        }
        noise.moving[j] = moving_rows > 0.0 ? std::sqrt(moving / moving_rows) : 0.0;
        noise.reversal[j] = reversal_rows > 0.0 ? std::sqrt(reversal / reversal_rows) : noise.moving[j];
        if (moving_rows == 0.0) {
            noise.moving[j] = noise.reversal[j];
        }
        largest = std::max({largest, noise.moving[j], noise.reversal[j]});
    }
    const double least = largest > 0.0 ? 1e-6 * largest : 1.0;
    noise.moving = noise.moving.cwiseMax(least);
    noise.reversal = noise.reversal.cwiseMax(noise.moving);
    return noise;
}

trace_fit fit_with_own_noise(const std::vector<traced_log>& logs, const std::vector<effect_term>& terms,
                             const row_noise* start) {
    const auto joints = static_cast<Eigen::Index>(logs.front().rows.W.size());
    row_noise noise =
        start != nullptr ? *start : row_noise{Eigen::VectorXd::Ones(joints), Eigen::VectorXd::Ones(joints)};
    for (int pass = 0; pass < noise_passes; ++pass) {
        noise = trace_fit(logs, terms, noise).estimated_noise();
    }
    return trace_fit(logs, terms, noise);
}

error_summary errors_of(const trace_fit& fit, bool held_back) {
    error_summary summary;
    double all_left = 0.0;
    double all_torque = 0.0;
    for (std::size_t j = 0; j < fit.residual().front().size(); ++j) {
        double left = 0.0;
        double torque = 0.0;
        double rows = 0.0;
        for (std::size_t l = 0; l < fit.logs().size(); ++l) {
            if (fit.logs()[l].held_back == held_back) {
                left += fit.residual()[l][j].squaredNorm();
                torque += fit.logs()[l].rows.Y[j].squaredNorm();
                rows += static_cast<double>(fit.residual()[l][j].size());
            }
        }
        summary.joints.push_back(
            {rows > 0.0 ? std::sqrt(left / rows) : 0.0, torque > 0.0 ? std::sqrt(left / torque) : 0.0});
        all_left += left;
        all_torque += torque;
    }
    summary.relative_error = all_torque > 0.0 ? std::sqrt(all_left / all_torque) : 0.0;
    return summary;
}

}  // namespace idim
