#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "idim/power_spectrum.hpp"
#include "idim/zero_phase_filter.hpp"
#include "link_swing.hpp"
#include "model_candidates.hpp"
#include "trace_fit.hpp"

namespace idim {

namespace {

/// Central differences along the samples, one-sided at the ends.
Eigen::VectorXd differentiated(const Eigen::Ref<const Eigen::VectorXd>& x, double rate) {
    const Eigen::Index n = x.size();
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    if (n > 2) {
        d.segment(1, n - 2) = (x.tail(n - 2) - x.head(n - 2)) * (0.5 * rate);
        d[0] = d[1];
        d[n - 1] = d[n - 2];
    }
    return d;
}

/// Where the second derivative of a signal sinks into its noise [Hz]: the lowest point of its spectrum, means over half
/// octaves, above the band of the signal itself; none where the spectrum does not rise fourfold again.
std::optional<double> noise_begins(const Eigen::VectorXd& signal, double rate) {
    constexpr double visible_rise = 4.0;
    const Eigen::Index segment = welch_segment(signal.size());
    const power_spectrum second = welch_spectrum(differentiated(differentiated(signal, rate), rate), rate, segment);
    const double step = std::exp2(0.25);
    double lowest = std::numeric_limits<double>::infinity();
    std::optional<double> valley;
    for (double f = energy_frequency(welch_spectrum(signal, rate, segment), 0.99, 0.5 * rate); f * step < 0.4 * rate;
         f *= step) {
        const Eigen::ArrayXd near = (second.frequency > f / step && second.frequency < f * step).cast<double>();
        const double level = near.sum() > 0.0 ? (near * second.density).sum() / near.sum() : lowest;
        if (level < lowest) {
            lowest = level;
            valley = f;
        } else if (level > visible_rise * lowest) {
            return valley;
        }
    }
    return std::nullopt;
}

/// The signal without what its second derivative shows of noise alone: a column made of noise would be fitted to the
/// torque that the controller gives in answer to that noise.
Eigen::VectorXd without_noise(const Eigen::VectorXd& signal, double rate) {
    constexpr int order = 4;
    constexpr Eigen::Index shortest = 64;  // samples, for a spectrum
    const std::optional<double> cutoff = signal.size() < shortest ? std::nullopt : noise_begins(signal, rate);
    return cutoff ? Eigen::VectorXd(zero_phase_filter(butterworth_lowpass(order, *cutoff / (0.5 * rate)), signal))
                  : signal;
}

/// What makes the link of a joint swing behind its motor in one log.
struct driven_link {
    const traced_log* log;
    swing_dynamics dynamics;
};

driven_link link_of(const traced_log& log, int joint) {
    const Eigen::Index n = log.tau_rigid.cols();
    return {&log, {without_noise(log.tau_rigid.col(joint), log.samples.rate), log.inertia.col(joint * n + joint)}};
}

/// Acceleration of the twist along the log.
Eigen::VectorXd twist_acceleration(const driven_link& link, int joint, const Eigen::VectorXd& shape) {
    return swing(link.dynamics, {{joint, shape[0], shape[1]}}, link.log->samples.rate).acceleration;
}

/// How the loss of a fit falls with the stiffness and damping of one transmission.
class swing_search {
  public:
    swing_search(const trace_fit& fit, int joint) : fit_(fit), joint_(joint) {
        double sum = 0.0;
        double samples = 0.0;
        for (std::size_t l = 0; l < fit.logs().size(); ++l) {
            if (!fit.logs()[l].held_back) {
                links_.push_back(link_of(fit.logs()[l], joint));
                places_.push_back(l);
                sum += links_.back().dynamics.inertia.sum();
                samples += static_cast<double>(links_.back().dynamics.inertia.rows());
                fastest_ = std::min(fastest_, part_of_rate * fit.logs()[l].samples.rate);
            }
        }
        inertia_ = sum / samples;
    }

    /// K and D of a link of mean inertia that swings at f [Hz] with a damping ratio.
    Eigen::Vector2d shape(double f, double ratio) const {
        const double w = 2.0 * M_PI * f;
        return {inertia_ * w * w, 2.0 * ratio * inertia_ * w};
    }

    bool can_swing() const { return inertia_ > 0.0; }

    std::vector<double> frequencies() const {
        std::vector<double> values;
        for (double f = slowest; f < fastest_; f *= grid_ratio) {
            values.push_back(f);
        }
        return values;
    }

    Eigen::Vector2d best_of_grid() const {
        Eigen::Vector2d best = shape(slowest, usual_ratio);
        double most = -std::numeric_limits<double>::infinity();
        for (const double f : frequencies()) {
            const Eigen::Vector2d here = shape(f, usual_ratio);
            if (const double found = gain(here); found > most) {
                most = found;
                best = here;
            }
        }
        return best;
    }

    /// The best near a shape: stiffness and damping in turn.
    Eigen::Vector2d refined(const Eigen::Vector2d& start) const {
        constexpr int bits = 12;
        double f = std::sqrt(start[0] / inertia_) / (2.0 * M_PI);
        double ratio = std::clamp(0.5 * start[1] / std::sqrt(start[0] * inertia_), least_ratio, most_ratio);
        for (int pass = 0; pass < 2; ++pass) {
            const double reach = pass == 0 ? grid_ratio : std::sqrt(grid_ratio);
            f = boost::math::tools::brent_find_minima([&](double at) { return -gain(shape(at, ratio)); }, f / reach,
                                                      f * reach, bits)
                    .first;
            ratio =
                std::exp(boost::math::tools::brent_find_minima([&](double at) { return -gain(shape(f, std::exp(at))); },
                                                               std::log(least_ratio), std::log(most_ratio), bits)
                             .first);
        }
        return gain(shape(f, ratio)) > gain(start) ? shape(f, ratio) : start;
    }

    /// Decrease of the loss by what the joint's own rows show.
    double gain(const Eigen::Vector2d& shape) const {
        const auto j = static_cast<std::size_t>(joint_);
        Eigen::VectorXd on_basis = Eigen::VectorXd::Zero(fit_.parameters());
        double square = 0.0;
        double product = 0.0;
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const Eigen::VectorXd torque =
                -links_[i].dynamics.inertia.cwiseProduct(twist_acceleration(links_[i], joint_, shape));
            const Eigen::VectorXd& weight = fit_.weight()[places_[i]][j];
            const Eigen::VectorXd X = weight.cwiseProduct(rows_of(*links_[i].log, joint_, torque));
            on_basis += fit_.basis(places_[i], joint_).transpose() * X;
            square += X.squaredNorm();
            product += X.dot(weight.cwiseProduct(fit_.residual()[places_[i]][j]));
        }
        return 2.0 * product - (square - on_basis.squaredNorm());
    }

  private:
    static constexpr double slowest = 3.0;       // Hz: a robot whose links swing slower is none that one would identify
    static constexpr double part_of_rate = 0.4;  // of the sampling: what swings faster follows at rest
    static constexpr double grid_ratio = 1.1;
    static constexpr double usual_ratio = 0.05;
    static constexpr double least_ratio = 0.01;
    static constexpr double most_ratio = 1.0;

    const trace_fit& fit_;
    int joint_;
    std::vector<driven_link> links_;
    std::vector<std::size_t> places_;
    double inertia_ = 0.0;
    double fastest_ = std::numeric_limits<double>::infinity();
};

/// The torque of a link that swings, less that of one that moves as its motor: -M twist'', at all joints.
class soft_joint final : public effect_candidate {
  public:
    soft_joint(int dof, int joint) : joint_(joint) {
        effect = "joint_elasticity";
        joints = {joint};
        for (int j = 0; j < dof; ++j) {
            touched.push_back(j);
        }
        linear_bound whole = {"share", "1"};
        whole.is_one = true;
        linear = {whole};
        constexpr double any = std::numeric_limits<double>::infinity();
        shape = {{"K", "N*m/rad", 0.0, any}, {"D", "N*m*s/rad", 0.0, any}};
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return column(log, joint, twist_acceleration(link_of(log, joint_), joint_, at));
    }
    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd& at) const override {
        const Eigen::VectorXd acceleration = twist_acceleration(link_of(log, joint_), joint_, at);
        std::vector<Eigen::MatrixXd> columns;
        for (const int joint : touched) {
            columns.push_back(column(log, joint, acceleration));
        }
        return columns;
    }
    /// The same for the inertias of the logs as they are by then.
    candidate_pointer relinearised(const Eigen::VectorXd& /*found*/) const override {
        return std::make_shared<soft_joint>(static_cast<int>(touched.size()), joint_);
    }
    std::vector<Eigen::VectorXd> starts(const trace_fit& fit) const override {
        const swing_search search(fit, joint_);
        if (!search.can_swing()) {
            return {Eigen::Vector2d::Ones()};  // no link swings: columns of zeros
        }
        const Eigen::Vector2d start = search.best_of_grid();
        return {search.gain(start) > 0.0 ? search.refined(start) : start};
    }
    int shapes_tried(const trace_fit& fit) const override {
        return static_cast<int>(swing_search(fit, joint_).frequencies().size());
    }
    Eigen::VectorXd shape_near(const trace_fit& fit, const Eigen::VectorXd& at) const override {
        const swing_search search(fit, joint_);
        return search.can_swing() ? Eigen::VectorXd(search.refined(at)) : at;
    }

  private:
    Eigen::MatrixXd column(const traced_log& log, int joint, const Eigen::VectorXd& acceleration) const {
        const Eigen::Index n = log.tau_rigid.cols();
        return rows_of(log, joint, -log.inertia.col(joint_ * n + joint).cwiseProduct(acceleration));
    }

    int joint_;
};

}  // namespace

candidate_pointer elasticity_candidate(int dof, int joint) {
    return std::make_shared<soft_joint>(dof, joint);
}

}  // namespace idim
