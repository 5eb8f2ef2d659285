#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>
#include <utility>

#include "link_parameters.hpp"
#include "model_candidates.hpp"
#include "regrouping.hpp"
#include "trace_fit.hpp"

namespace idim {

namespace {

/// Ten columns that are nearly the model's own would take any size: what an interval leaves outside the span is more.
constexpr double least_of_a_load = 1e-2;
/// A load is on for at least, and off for at least, this part of a log.
constexpr double shortest_part = 0.05;

/// Sums over the rows up to each of ascending times: Gram matrix of the columns, their part in the span of the model,
/// and their product with the residual.
struct running_sums {
    std::vector<Eigen::MatrixXd> gram;      ///< m x m
    std::vector<Eigen::MatrixXd> on_basis;  ///< k x m
    std::vector<Eigen::VectorXd> on_residual;
};

/// Adds what the rows of one joint in one log give to the interval before times[i].
void add_rows(const trace_fit& fit, std::size_t l, int joint, const Eigen::MatrixXd& columns,
              const std::vector<double>& times, running_sums& sums) {
    const auto j = static_cast<std::size_t>(joint);
    const observation_block& rows = fit.logs()[l].rows;
    const Eigen::VectorXd& weight = fit.weight()[l][j];
    const Eigen::MatrixXd X = weight.asDiagonal() * columns;
    const Eigen::VectorXd r = weight.cwiseProduct(fit.residual()[l][j]);
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        Eigen::Index end = first;
        while (end < X.rows() && rows.t[rows.kept[j][static_cast<std::size_t>(end)]] < times[i]) {
            ++end;
        }
        const auto part = X.middleRows(first, end - first);
        sums.gram[i] += part.transpose() * part;
        sums.on_basis[i] += fit.basis(l, joint).middleRows(first, end - first).transpose() * part;
        sums.on_residual[i] += part.transpose() * r.segment(first, end - first);
        first = end;
    }
}

/// Decrease of the loss by columns that count between two of the times.
double gain_between(const running_sums& sums, std::size_t from, std::size_t to) {
    const Eigen::MatrixXd gram = sums.gram[to] - sums.gram[from];
    const Eigen::MatrixXd on_basis = sums.on_basis[to] - sums.on_basis[from];
    const Eigen::VectorXd g = sums.on_residual[to] - sums.on_residual[from];
    const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt();
    const Eigen::VectorXd inverse = (scale.array() > 1e-12 * scale.maxCoeff()).select(scale.cwiseInverse(), 0.0);
    const Eigen::MatrixXd outside =
        inverse.asDiagonal() * (gram - on_basis.transpose() * on_basis) * inverse.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(outside);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * inverse.cwiseProduct(g);
    double gain = 0.0;
    for (Eigen::Index i = 0; i < along.size(); ++i) {
        gain += eigen.eigenvalues()[i] > least_of_a_load * least_of_a_load
                    ? along[i] * along[i] / eigen.eigenvalues()[i]
                    : 0.0;
    }
    return gain;
}

class part_time_load final : public effect_candidate {
  public:
    part_time_load(const idim_model_interface& model, int joint)
        : B_(link_columns(model, regrouping_of(model), joint)) {
        effect = "payload";
        joints = {joint};
        for (int j = 0; j < model.dof; ++j) {
            touched.push_back(j);
        }
        for (std::size_t c = 0; c < inertial_names.size(); ++c) {
            linear.push_back({"P" + std::string(inertial_names[c]), inertial_units[c]});
        }
        least_outside = least_of_a_load;
        when_permanent = "a load that never comes off is part of the link; a log with it and one without would show it";
        shape = {{"t0", "s", -1e9, 1e9, true}, {"t1", "s", -1e9, 1e9, true}};
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& interval) const override {
        const auto j = static_cast<std::size_t>(joint);
        Eigen::MatrixXd columns = log.rows.W[j] * B_;
        for (Eigen::Index k = 0; k < columns.rows(); ++k) {
            const double t = log.rows.t[log.rows.kept[j][static_cast<std::size_t>(k)]];
            if (t < interval[0] || t >= interval[1]) {
                columns.row(k).setZero();
            }
        }
        return columns;
    }

    /// The best interval, by three grids one within the other.
    std::vector<Eigen::VectorXd> starts(const trace_fit& fit) const override {
        double first = 0.0;
        double last = 0.0;
        for (const traced_log& log : fit.logs()) {
            if (!log.held_back) {
                first = std::min(first, log.rows.t[0]);
                last = std::max(last, log.rows.t[log.rows.t.size() - 1]);
            }
        }
        double step = (last - first) / coarse;
        std::vector<double> times;
        for (int i = 0; i <= coarse; ++i) {
            times.push_back(first + i * step + (i == coarse ? 1e-9 : 0.0));
        }
        const double whole = last - first;
        std::pair<double, double> best = best_interval(fit, times, whole, 1e18);
        for (int level = 0; level < 2; ++level) {
            times.clear();
            for (int i = -fine; i <= fine; ++i) {
                times.push_back(best.first + i * step / fine);
                times.push_back(best.second + i * step / fine);
            }
            std::sort(times.begin(), times.end());
            best = best_interval(fit, times, whole, 1.01 * step, best);
            step /= fine;
        }
        return {Eigen::Vector2d(best.first, best.second)};
    }

    int shapes_tried(const trace_fit& /*fit*/) const override { return coarse * coarse / 2; }

  private:
    static constexpr int coarse = 48;
    static constexpr int fine = 12;

    /// The pair of times with the largest gain, each within `reach` of `near`.
    std::pair<double, double> best_interval(const trace_fit& fit, const std::vector<double>& times, double whole,
                                            double reach, std::pair<double, double> near = {0.0, 0.0}) const {
        const running_sums sums = sums_at(fit, times);
        std::pair<double, double> best = {times.front(), times.back()};
        double most = -1.0;
        for (std::size_t begin = 0; begin < times.size(); ++begin) {
            for (std::size_t end = begin + 1; end < times.size(); ++end) {
                const double duration = times[end] - times[begin];
                if (std::abs(times[begin] - near.first) > reach || std::abs(times[end] - near.second) > reach ||
                    duration < shortest_part * whole || duration > (1.0 - shortest_part) * whole) {
                    continue;
                }
                const double gain = gain_between(sums, begin, end);
                if (gain > most) {
                    most = gain;
                    best = {times[begin], times[end]};
                }
            }
        }
        return best;
    }

    running_sums sums_at(const trace_fit& fit, const std::vector<double>& times) const {
        const Eigen::Index k = fit.parameters();
        const Eigen::Index m = B_.cols();
        running_sums sums;
        sums.gram.assign(times.size(), Eigen::MatrixXd::Zero(m, m));
        sums.on_basis.assign(times.size(), Eigen::MatrixXd::Zero(k, m));
        sums.on_residual.assign(times.size(), Eigen::VectorXd::Zero(m));
        for (std::size_t l = 0; l < fit.logs().size(); ++l) {
            for (std::size_t j = 0; j < touched.size() && !fit.logs()[l].held_back; ++j) {
                add_rows(fit, l, static_cast<int>(j), fit.logs()[l].rows.W[j] * B_, times, sums);
            }
        }
        for (std::size_t i = 1; i < times.size(); ++i) {
            sums.gram[i] += sums.gram[i - 1];
            sums.on_basis[i] += sums.on_basis[i - 1];
            sums.on_residual[i] += sums.on_residual[i - 1];
        }
        return sums;
    }

    Eigen::MatrixXd B_;
};

}  // namespace

candidate_pointer payload_candidate(const idim_model_interface& model, int joint) {
    return std::make_shared<part_time_load>(model, joint);
}

}  // namespace idim
