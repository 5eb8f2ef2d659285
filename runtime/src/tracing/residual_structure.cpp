#include "residual_structure.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "column_span.hpp"
#include "effect_evidence.hpp"

namespace idim {

namespace {

constexpr int knots_alone = 8;
constexpr int knots_in_pair = 5;
constexpr double least_predicted = 0.1;       ///< of the variance held back: less is nothing to act upon
constexpr double simpler_share = 0.8;         ///< of what two signals explain is enough for one
constexpr double significance_of_all = 0.05;  ///< over all joints
constexpr int rows_per_column = 3;            ///< of the surface and the model, on either data
constexpr double memories_in_shift = 4.0;     ///< correlation lengths that a shift exceeds
constexpr std::uint64_t seed = 1;             ///< of the shifts: the same log gives the same answer

using signal_set = std::vector<Eigen::Index>;  ///< columns of joint_residual::signals

/// Knots with as many rows of the signal between each two.
Eigen::VectorXd quantiles(Eigen::VectorXd signal, int count) {
    std::sort(signal.begin(), signal.end());
    Eigen::VectorXd knots(count);
    for (int k = 0; k < count; ++k) {
        knots[k] = signal[(signal.size() - 1) * k / (count - 1)];
    }
    return knots;
}

/// Hat functions over knots, one column each; constant beyond the outer ones.
Eigen::MatrixXd hats(const Eigen::VectorXd& signal, const Eigen::VectorXd& knots) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(signal.size(), knots.size());
    for (Eigen::Index i = 0; i < signal.size(); ++i) {
        const double x = std::clamp(signal[i], knots[0], knots[knots.size() - 1]);
        const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, x) - knots.begin();
        const double width = knots[after] - knots[after - 1];
        const double share = width > 0.0 ? (x - knots[after - 1]) / width : 0.0;
        columns(i, after - 1) = 1.0 - share;
        columns(i, after) = share;
    }
    return columns;
}

/// Surface over one or two signals, its knots from the fitted rows.
class hat_surface {
  public:
    hat_surface(const joint_residual& fitted, const signal_set& set) : set_(set) {
        for (const Eigen::Index s : set) {
            knots_.push_back(quantiles(fitted.signals.col(s), set.size() == 1 ? knots_alone : knots_in_pair));
        }
    }

    Eigen::MatrixXd columns(const joint_residual& rows) const {
        Eigen::MatrixXd all = hats(rows.signals.col(set_[0]), knots_[0]);
        if (set_.size() == 2) {
            const Eigen::MatrixXd first = all;
            const Eigen::MatrixXd second = hats(rows.signals.col(set_[1]), knots_[1]);
            all.resize(first.rows(), first.cols() * second.cols());
            for (Eigen::Index a = 0; a < first.cols(); ++a) {
                for (Eigen::Index b = 0; b < second.cols(); ++b) {
                    all.col(a * second.cols() + b) = first.col(a).cwiseProduct(second.col(b));
                }
            }
        }
        return rows.weight.asDiagonal() * all;
    }

  private:
    signal_set set_;
    std::vector<Eigen::VectorXd> knots_;
};

std::vector<signal_set> sets_of(const std::vector<signal_source>& sources) {
    std::vector<signal_set> sets;
    const auto count = static_cast<Eigen::Index>(sources.size());
    for (Eigen::Index a = 0; a < count; ++a) {
        sets.push_back({a});
    }
    const auto pairs = [&](Eigen::Index s) {
        const auto what = sources[static_cast<std::size_t>(s)].what;
        return what != signal_source::kind::qdd && what != signal_source::kind::t;
    };
    for (Eigen::Index a = 0; a < count; ++a) {
        for (Eigen::Index b = a + 1; b < count; ++b) {
            if (pairs(a) && pairs(b)) {
                sets.push_back({a, b});
            }
        }
    }
    return sets;
}

/// One joint's residual against all sets of signals.
class dependence_test {
  public:
    dependence_test(const trace_fit& fit, int joint)
        : sources_(sources_for(fit, joint)),
          fitted_(residual_of(fit, joint, sources_, false)),
          held_back_(residual_of(fit, joint, sources_, true)) {
        if (fitted_.left.size() > 0) {
            model_ = orthonormal(fitted_.model);
            left_ = outside(model_, fitted_.left);
        }
        const Eigen::Index rows = std::min(fitted_.left.size(), held_back_.left.size());
        for (signal_set& set : sets_of(sources_)) {
            const int columns = set.size() == 1 ? knots_alone : knots_in_pair * knots_in_pair;
            if (rows >= rows_per_column * (model_.cols() + columns)) {
                sets_.push_back(std::move(set));
            }
        }
    }

    const std::vector<signal_source>& sources() const { return sources_; }
    /// Those that the rows suffice for, single signals first; empty where they suffice for none.
    const std::vector<signal_set>& sets() const { return sets_; }

    /// Part of the fitted residual that each set explains.
    Eigen::VectorXd explained_where_fitted() const {
        Eigen::VectorXd share(static_cast<Eigen::Index>(sets_.size()));
        for (std::size_t s = 0; s < sets_.size(); ++s) {
            share[static_cast<Eigen::Index>(s)] =
                (outside_of(sets_[s]).transpose() * left_).squaredNorm() / left_.squaredNorm();
        }
        return share;
    }

    /// Part of the residual held back that a set explains with what was fitted. Heights of the surface that few rows
    /// tell, or the model takes up, are kept to the size of the residual: one row more for each, of no torque.
    double explained_held_back(const signal_set& set) const {
        const hat_surface surface(fitted_, set);
        const Eigen::MatrixXd columns = surface.columns(fitted_);
        const Eigen::Index rows = columns.rows();
        const Eigen::Index heights = columns.cols();
        Eigen::MatrixXd all(rows + heights, fitted_.model.cols() + heights);
        all.topRows(rows) << fitted_.model, columns;
        all.bottomLeftCorner(heights, fitted_.model.cols()).setZero();
        all.bottomRightCorner(heights, heights) = fitted_.weight.mean() * Eigen::MatrixXd::Identity(heights, heights);
        Eigen::VectorXd left = Eigen::VectorXd::Zero(rows + heights);
        left.head(rows) = fitted_.left;
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
        solver.setThreshold(1e-6);
        solver.compute(all);
        const Eigen::VectorXd coefficient = solver.solve(left);
        Eigen::MatrixXd other(held_back_.left.size(), all.cols());
        other << held_back_.model, surface.columns(held_back_);
        return 1.0 - (held_back_.left - other * coefficient).squaredNorm() / held_back_.left.squaredNorm();
    }

    /// How often a shifted residual has as large a standardised share for its best set as `set` has; one count more, of
    /// the residual itself. `length` [rows] is its correlation length.
    double p_value(const signal_set& chosen, double length, int shifts) const {
        const Eigen::MatrixXd shifted = shifted_residuals(length, shifts);
        Eigen::VectorXd largest = Eigen::VectorXd::Constant(shifted.cols(), -1e300);
        double own = 0.0;
        for (const signal_set& set : sets_) {
            const Eigen::VectorXd share = (outside_of(set).transpose() * shifted).colwise().squaredNorm();
            const Eigen::VectorXd others = share.tail(share.size() - 1);
            const double mean = others.mean();
            const double deviation =
                std::sqrt((others.array() - mean).square().sum() / static_cast<double>(others.size() - 1));
            const Eigen::VectorXd standardised = (share.array() - mean) / deviation;
            largest = largest.cwiseMax(standardised);
            own = set == chosen ? standardised[0] : own;
        }
        const auto as_large = (largest.tail(largest.size() - 1).array() >= own).count();
        return (1.0 + static_cast<double>(as_large)) / static_cast<double>(largest.size());
    }

  private:
    Eigen::MatrixXd outside_of(const signal_set& set) const {
        return orthonormal(outside(model_, hat_surface(fitted_, set).columns(fitted_)));
    }

    /// The residual, then copies shifted in time, wrapped around; all of norm 1 outside the span of the model.
    Eigen::MatrixXd shifted_residuals(double length, int shifts) const {
        const Eigen::Index n = left_.size();
        const auto least = std::min<Eigen::Index>(n / 10, static_cast<Eigen::Index>(memories_in_shift * length) + 1);
        std::mt19937_64 random(seed);
        Eigen::MatrixXd all(n, shifts + 1);
        all.col(0) = left_;
        for (int k = 1; k <= shifts; ++k) {
            const auto by = least + static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(n - 2 * least));
            all.col(k) << left_.tail(by), left_.head(n - by);
        }
        return outside(model_, all).colwise().normalized();
    }

    std::vector<signal_source> sources_;
    joint_residual fitted_, held_back_;
    std::vector<signal_set> sets_;
    Eigen::MatrixXd model_;  ///< orthonormal span of the model's columns, on the fitted rows of this joint
    Eigen::VectorXd left_;   ///< the residual outside it
};

/// The set that explains most where fitted; one signal where that holds on held back data nearly as well as two.
std::optional<signal_set> best_set(const dependence_test& test, double& explained) {
    const Eigen::VectorXd share = test.explained_where_fitted();
    const auto singles = static_cast<Eigen::Index>(test.sources().size());
    Eigen::Index alone = 0;
    Eigen::Index best = 0;
    share.head(singles).maxCoeff(&alone);
    share.maxCoeff(&best);
    const double of_best = test.explained_held_back(test.sets()[static_cast<std::size_t>(best)]);
    const double of_one = test.explained_held_back(test.sets()[static_cast<std::size_t>(alone)]);
    const bool one = of_one >= simpler_share * of_best;
    explained = one ? of_one : of_best;
    if (!(explained >= least_predicted)) {
        return std::nullopt;
    }
    return test.sets()[static_cast<std::size_t>(one ? alone : best)];
}

}  // namespace

std::vector<signal_dependence> find_dependences(const trace_fit& fit) {
    const auto joints = static_cast<int>(fit.residual().front().size());
    const int shifts = static_cast<int>(std::ceil(2.0 * joints / significance_of_all)) - 1;
    std::vector<signal_dependence> found;
    for (int j = 0; j < joints; ++j) {
        const dependence_test test(fit, j);
        double explained = 0.0;
        const std::optional<signal_set> set = test.sets().empty() ? std::nullopt : best_set(test, explained);
        if (set &&
            test.p_value(*set, correlation_length(fit, fit.residual(), j), shifts) <= significance_of_all / joints) {
            signal_dependence dependence{j, {}, explained};
            for (const Eigen::Index s : *set) {
                dependence.signals.push_back(test.sources()[static_cast<std::size_t>(s)]);
            }
            found.push_back(std::move(dependence));
        }
    }
    return found;
}

}  // namespace idim
