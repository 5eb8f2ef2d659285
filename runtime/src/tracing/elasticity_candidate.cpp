#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "link_swing.hpp"
#include "model_candidates.hpp"
#include "trace_fit.hpp"

namespace idim {

namespace {

/// What makes the link of a joint swing behind its motor in one log.
struct driven_link {
    const traced_log* log;
    swing_dynamics dynamics;
};

driven_link link_of(const traced_log& log, int joint) {
    const Eigen::Index n = log.tau_rigid.cols();
    return {&log, {log.tau_rigid.col(joint), log.inertia.col(joint * n + joint)}};
}

/// Acceleration of the twist along the log.
Eigen::VectorXd twist_acceleration(const driven_link& link, int joint, const Eigen::VectorXd& shape) {
    return swing(link.dynamics, {{joint, shape[0], shape[1]}}, link.log->samples.rate).acceleration;
}

/// Rows of what the twist of one transmission takes from the torque of a joint.
Eigen::VectorXd torque_of_twist(const traced_log& log, int twisted, int joint, const Eigen::VectorXd& acceleration) {
    const Eigen::Index n = log.tau_rigid.cols();
    return rows_of(log, joint, -log.inertia.col(twisted * n + joint).cwiseProduct(acceleration));
}

/// Those from the acceleration filtered once, with the inertia at the rows' own times: it changes slowly.
class quick_twist {
  public:
    quick_twist(const traced_log& log, int twisted, const Eigen::VectorXd& acceleration)
        : log_(log), twisted_(twisted), filtered_(decimate(acceleration, log.decimation)) {}

    Eigen::VectorXd torque(int joint) const {
        const Eigen::Index column = twisted_ * log_.tau_rigid.cols() + joint;
        const std::vector<Eigen::Index>& kept = log_.rows.kept[static_cast<std::size_t>(joint)];
        Eigen::VectorXd rows(static_cast<Eigen::Index>(kept.size()));
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const Eigen::Index sample = std::min(kept[k] * log_.decimation, log_.inertia.rows() - 1);
            rows[static_cast<Eigen::Index>(k)] = -log_.inertia(sample, column) * filtered_(kept[k]);
        }
        return rows;
    }

  private:
    const traced_log& log_;
    int twisted_;
    Eigen::VectorXd filtered_;
};

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

    /// Decrease of the loss.
    double gain(const Eigen::Vector2d& shape) const {
        Eigen::VectorXd on_basis = Eigen::VectorXd::Zero(fit_.parameters());
        double square = 0.0;
        double product = 0.0;
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const quick_twist twist(*links_[i].log, joint_, twist_acceleration(links_[i], joint_, shape));
            for (std::size_t j = 0; j < fit_.weight()[places_[i]].size(); ++j) {
                const int joint = static_cast<int>(j);
                const Eigen::VectorXd& weight = fit_.weight()[places_[i]][j];
                const Eigen::VectorXd X = weight.cwiseProduct(twist.torque(joint));
                on_basis += fit_.basis(places_[i], joint).transpose() * X;
                square += X.squaredNorm();
                product += X.dot(weight.cwiseProduct(fit_.residual()[places_[i]][j]));
            }
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
        return torque_of_twist(log, joint_, joint, twist_acceleration(link_of(log, joint_), joint_, at));
    }
    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd& at) const override {
        const Eigen::VectorXd acceleration = twist_acceleration(link_of(log, joint_), joint_, at);
        std::vector<Eigen::MatrixXd> columns;
        for (const int joint : touched) {
            columns.emplace_back(torque_of_twist(log, joint_, joint, acceleration));
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
    int joint_;
};

}  // namespace

candidate_pointer elasticity_candidate(int dof, int joint) {
    return std::make_shared<soft_joint>(dof, joint);
}

}  // namespace idim
