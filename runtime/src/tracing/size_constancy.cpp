#include "size_constancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "effect_evidence.hpp"

namespace idim {

namespace {

constexpr double change_significance = 0.01;  ///< corrected for the joints tried: a true name is lost as rarely as that
/// Gain of the change over that of the term: a size that varies by less than a third of itself (rms) is described.
constexpr double least_change = 0.1;

/// Where a joint was over all logs.
struct position_range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    /// From -1 at the lowest to 1 at the highest.
    double place_of(double q) const { return (2.0 * q - low - high) / (high - low); }
};

position_range range_of(const trace_fit& fit, int joint) {
    position_range range;
    for (const traced_log& log : fit.logs()) {
        range.low = std::min(range.low, log.samples.q.col(joint).minCoeff());
        range.high = std::max(range.high, log.samples.q.col(joint).maxCoeff());
    }
    return range;
}

/// The torque that a term was found to have, times the position of another joint and its square.
class changing_size final : public effect_candidate {
  public:
    changing_size(effect_term term, Eigen::VectorXd coefficients, int other, position_range range)
        : term_(std::move(term)), coefficients_(std::move(coefficients)), other_(other), range_(range) {
        effect = "changing_size";
        joints = touched = term_.candidate->touched;
        linear = {{"c1", "1"}, {"c2", "1"}};
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& /*at*/) const override {
        const Eigen::VectorXd torque = term_.candidate->rows(log, joint, term_.shape) * coefficients_;
        const std::vector<Eigen::Index>& kept = log.rows.kept[static_cast<std::size_t>(joint)];
        Eigen::MatrixXd X(torque.size(), 2);
        for (Eigen::Index k = 0; k < torque.size(); ++k) {
            const Eigen::Index sample =
                std::min(kept[static_cast<std::size_t>(k)] * log.decimation, log.samples.samples() - 1);
            const double u = range_.place_of(log.samples.q(sample, other_));
            X.row(k) << torque[k] * u, torque[k] * u * u;
        }
        return X;
    }

  private:
    effect_term term_;
    Eigen::VectorXd coefficients_;
    int other_;
    position_range range_;
};

double gain_of(const trace_fit& fit, std::size_t term) {
    std::vector<effect_term> others = fit.terms();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
    return trace_fit(fit.logs(), std::move(others), fit.noise()).loss() - fit.loss();
}

/// Whether the change shows in every log, not in one of them.
bool shows_everywhere(const trace_fit& fit, const effect_evidence& evidence) {
    const log_series left = residual_with(fit, evidence);
    for (std::size_t l = 0; l < left.size(); ++l) {
        const auto joint = static_cast<std::size_t>(evidence.term.candidate->touched.front());
        const Eigen::VectorXd& weight = fit.weight()[l][joint];
        if (left[l][joint].cwiseProduct(weight).squaredNorm() >=
            fit.residual()[l][joint].cwiseProduct(weight).squaredNorm()) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::optional<int> joint_that_changes(const trace_fit& fit, std::size_t term) {
    const effect_term& tested = fit.terms()[term];
    if (tested.candidate->touched.size() != 1 || tested.candidate->per_log) {
        return std::nullopt;
    }
    std::vector<traced_log> logs = fit.logs();
    for (traced_log& log : logs) {
        log.held_back = false;
    }
    const trace_fit pooled(logs, fit.terms(), fit.noise());
    const auto joints = static_cast<int>(fit.residual().front().size());
    std::optional<int> found;
    double most = least_change * gain_of(pooled, term);
    for (int other = 0; other < joints; ++other) {
        const position_range range = range_of(pooled, other);
        if (other == tested.candidate->touched.front() || !(range.high > range.low)) {
            continue;
        }
        const auto candidate = std::make_shared<changing_size>(tested, pooled.coefficients(term), other, range);
        const effect_evidence evidence = test_on_fitted(pooled, {candidate, Eigen::VectorXd()}, false);
        if (evidence.gain > most && corrected(evidence.p_value, joints - 1) < change_significance &&
            shows_everywhere(pooled, evidence)) {
            found = other;
            most = evidence.gain;
        }
    }
    return found;
}

}  // namespace idim
