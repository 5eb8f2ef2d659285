#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "idim/recorded_states.hpp"
#include "idim/zero_phase_filter.hpp"
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

twist_motion twist_of(const driven_link& link, int joint, const Eigen::VectorXd& shape) {
    return swing(link.dynamics, {{joint, shape[0], shape[1]}}, link.log->samples.rate);
}

/// What the twist of one transmission changes in the torque of every joint [samples x n].
Eigen::MatrixXd torques_of(const idim_model_interface& model, const traced_log& log, int joint,
                           const twist_motion& twist) {
    filtered_samples link = log.samples;
    link.q.col(joint) -= twist.angle;
    link.qd.col(joint) -= twist.rate;
    link.qdd.col(joint) -= twist.acceleration;
    return model_torques(model, link, log.chi_rigid) - log.tau_rigid;
}

/// Rows of its largest part, that of the inertia, from the acceleration filtered once: inertias change slowly.
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
    swing_search(const idim_model_interface& model, const trace_fit& fit, int joint)
        : model_(model), fit_(fit), joint_(joint) {
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
        const auto count =
            static_cast<std::size_t>(1.0 + std::max(0.0, std::log(fastest_ / slowest)) / std::log(grid_ratio));
        std::vector<double> values(count, slowest);
        for (std::size_t i = 1; i < count; ++i) {
            values[i] = grid_ratio * values[i - 1];
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

    /// The best near a shape, stiffness and damping in turn, by the exact columns.
    Eigen::Vector2d refined(const Eigen::Vector2d& start) const {
        constexpr int bits = 10;
        const auto loss = [&](double f, double ratio) { return -exact_gain(shape(f, ratio)); };
        double f = std::sqrt(start[0] / inertia_) / (2.0 * M_PI);
        double ratio = std::clamp(0.5 * start[1] / std::sqrt(start[0] * inertia_), least_ratio, most_ratio);
        for (const double reach : {grid_ratio, std::sqrt(grid_ratio)}) {
            f = boost::math::tools::brent_find_minima([&](double at) { return loss(at, ratio); }, f / reach, f * reach,
                                                      bits)
                    .first;
            ratio = std::exp(boost::math::tools::brent_find_minima([&](double at) { return loss(f, std::exp(at)); },
                                                                   std::log(least_ratio), std::log(most_ratio), bits)
                                 .first);
        }
        return loss(f, ratio) < -exact_gain(start) ? shape(f, ratio) : start;
    }

    /// Decrease of the loss by the largest part of the columns, quickly computed.
    double gain(const Eigen::Vector2d& shape) const {
        return gain_by([&](const driven_link& link) {
            const quick_twist twist(*link.log, joint_, twist_of(link, joint_, shape).acceleration);
            return [twist](int joint) { return twist.torque(joint); };
        });
    }

    /// The same by the columns themselves.
    double exact_gain(const Eigen::Vector2d& shape) const {
        return gain_by([&](const driven_link& link) {
            const Eigen::MatrixXd torques = torques_of(model_, *link.log, joint_, twist_of(link, joint_, shape));
            return
                [&link, torques](int joint) { return Eigen::VectorXd(rows_of(*link.log, joint, torques.col(joint))); };
        });
    }

  private:
    /// Decrease of the loss by rows that a function of the link gives for every joint.
    template <class RowsOfLink>
    double gain_by(const RowsOfLink& rows_of_link) const {
        Eigen::VectorXd on_basis = Eigen::VectorXd::Zero(fit_.parameters());
        double square = 0.0;
        double product = 0.0;
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const auto rows = rows_of_link(links_[i]);
            for (std::size_t j = 0; j < fit_.weight()[places_[i]].size(); ++j) {
                const int joint = static_cast<int>(j);
                const Eigen::VectorXd& weight = fit_.weight()[places_[i]][j];
                const Eigen::VectorXd X = weight.cwiseProduct(rows(joint));
                on_basis += fit_.basis(places_[i], joint).transpose() * X;
                square += X.squaredNorm();
                product += X.dot(weight.cwiseProduct(fit_.residual()[places_[i]][j]));
            }
        }
        return 2.0 * product - (square - on_basis.squaredNorm());
    }

    static constexpr double slowest = 3.0;       // Hz: a robot whose links swing slower is none that one would identify
    static constexpr double part_of_rate = 0.4;  // of the sampling: what swings faster follows at rest
    static constexpr double grid_ratio = 1.1;
    static constexpr double usual_ratio = 0.05;
    static constexpr double least_ratio = 0.01;
    static constexpr double most_ratio = 1.0;

    const idim_model_interface& model_;
    const trace_fit& fit_;
    int joint_;
    std::vector<driven_link> links_;
    std::vector<std::size_t> places_;
    double inertia_ = 0.0;
    double fastest_ = std::numeric_limits<double>::infinity();
};

/// The torque of a link that swings, less that of one that moves as its motor, at all joints.
class soft_joint final : public effect_candidate {
  public:
    soft_joint(const idim_model_interface& model, int joint) : model_(model), joint_(joint) {
        effect = "joint_elasticity";
        joints = {joint};
        for (int j = 0; j < model.dof; ++j) {
            touched.push_back(j);
        }
        linear_bound whole = {"share", "1"};
        whole.is_one = true;
        linear = {whole};
        constexpr double any = std::numeric_limits<double>::infinity();
        shape = {{"K", "N*m/rad", 0.0, any}, {"D", "N*m*s/rad", 0.0, any}};
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return rows_of(log, joint, torques(log, at).col(joint));
    }
    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd& at) const override {
        const Eigen::MatrixXd changed = torques(log, at);
        std::vector<Eigen::MatrixXd> columns;
        for (const int joint : touched) {
            columns.push_back(rows_of(log, joint, changed.col(joint)));
        }
        return columns;
    }
    /// The same for the inertias of the logs as they are by then.
    candidate_pointer relinearised(const Eigen::VectorXd& /*found*/) const override {
        return std::make_shared<soft_joint>(model_, joint_);
    }
    std::vector<Eigen::VectorXd> starts(const trace_fit& fit) const override {
        const swing_search search(model_, fit, joint_);
        if (!search.can_swing()) {
            return {Eigen::Vector2d::Ones()};  // no link swings: columns of zeros
        }
        const Eigen::Vector2d start = search.best_of_grid();
        return {search.gain(start) > worth_refining ? search.refined(start) : start};
    }
    int shapes_tried(const trace_fit& fit) const override {
        return static_cast<int>(swing_search(model_, fit, joint_).frequencies().size());
    }
    Eigen::VectorXd shape_near(const trace_fit& fit, const Eigen::VectorXd& at) const override {
        const swing_search search(model_, fit, joint_);
        return search.can_swing() ? Eigen::VectorXd(search.refined(at)) : at;
    }

  private:
    static constexpr double worth_refining = 10.0;  ///< of the loss, in variances of a row

    Eigen::MatrixXd torques(const traced_log& log, const Eigen::VectorXd& at) const {
        return torques_of(model_, log, joint_, twist_of(link_of(log, joint_), joint_, at));
    }

    const idim_model_interface& model_;
    int joint_;
};

}  // namespace

candidate_pointer elasticity_candidate(const idim_model_interface& model, int joint) {
    return std::make_shared<soft_joint>(model, joint);
}

}  // namespace idim
