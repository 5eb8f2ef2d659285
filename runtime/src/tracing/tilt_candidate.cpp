#include <Eigen/SVD>
#include <cmath>
#include <utility>
#include <vector>

#include "link_parameters.hpp"
#include "model_candidates.hpp"
#include "regrouping.hpp"

namespace idim {

namespace {

constexpr double steepest = 0.8;   ///< rad, as in the effect's file
constexpr double rounding = 1e-9;  ///< of the largest singular value

/// Base parameters per unit of the inertial standard parameters of all links, b x 10 n.
Eigen::MatrixXd links_of(const idim_model_interface& model) {
    const Eigen::MatrixXd all = regrouping_of(model);
    Eigen::MatrixXd B(model.n_base, 10 * model.dof);
    for (int joint = 0; joint < model.dof; ++joint) {
        B.middleCols(10 * joint, 10) = link_columns(model, all, joint);
    }
    return B;
}

/// One axis: the model with gravity turned about it, and base parameters of that model.
struct turned_parameters {
    const idim_model_interface* model;
    double angle;
    Eigen::MatrixXd chi;  ///< b x (1 + r): the present links, then directions that only the turned gravity shows
};

/// Torques at rest along the motion of a log, samples x n.
Eigen::MatrixXd torques_at_rest(const idim_model_interface& model, const filtered_samples& samples,
                                const Eigen::VectorXd& chi) {
    const auto count = static_cast<std::size_t>(samples.samples());
    const Eigen::MatrixXd still = Eigen::MatrixXd::Zero(samples.samples(), model.dof);
    const idim_samples rest = {count,
                               count,
                               samples.q.data(),
                               still.data(),
                               still.data(),
                               samples.t.data(),
                               samples.temp.size() > 0 ? samples.temp.data() : nullptr};
    Eigen::MatrixXd tau(samples.samples(), model.dof);
    model.inverse_dynamics_batch(&rest, chi.data(), tau.data(), count);
    return tau;
}

class turned_gravity final : public effect_candidate {
  public:
    turned_gravity(const idim_model_interface& model, const std::vector<turned_model>& turned,
                   const Eigen::VectorXd& chi)
        : model_(model), rigid_(rigid_part(model, chi)) {
        effect = "base_tilt";
        for (int j = 0; j < model.dof; ++j) {
            joints.push_back(j);
        }
        touched = joints;
        is_of_the_robot = true;
        role = column_role::shape;
        const Eigen::MatrixXd B = links_of(model);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(B, Eigen::ComputeThinU | Eigen::ComputeFullV);
        const Eigen::Index rank = (svd.singularValues().array() > rounding * svd.singularValues().maxCoeff()).count();
        const Eigen::VectorXd links =
            svd.matrixV().leftCols(rank) *
            (svd.matrixU().leftCols(rank).transpose() * rigid_).cwiseQuotient(svd.singularValues().head(rank));
        const Eigen::MatrixXd unseen = svd.matrixV().rightCols(B.cols() - rank);
        for (const turned_model& one : turned) {
            axes_.push_back({one.model, one.angle, parameters_in(*one.model, links, unseen)});
            linear.push_back({one.shape, "rad", -steepest, 0.0, steepest});
        }
        for (const turned_parameters& axis : axes_) {
            for (Eigen::Index c = 1; c < axis.chi.cols(); ++c) {
                linear.push_back({"moment", "N*m"});
                linear.back().is_nuisance = true;
            }
        }
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return touched_rows(log, at)[static_cast<std::size_t>(joint)];
    }

    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd&) const override {
        const Eigen::MatrixXd upright = torques_at_rest(model_, log.samples, rigid_);
        std::vector<Eigen::MatrixXd> columns(
            joints.size(), Eigen::MatrixXd::Zero(log.samples.samples(), static_cast<Eigen::Index>(linear.size())));
        auto moment = static_cast<Eigen::Index>(axes_.size());
        for (std::size_t a = 0; a < axes_.size(); ++a) {
            const turned_parameters& axis = axes_[a];
            for (Eigen::Index c = 0; c < axis.chi.cols(); ++c) {
                // Gravity turned by an angle is cos times the declared one and sin times the one that is asked for.
                Eigen::MatrixXd tau = torques_at_rest(*axis.model, log.samples, axis.chi.col(c));
                tau -= (c == 0 ? std::cos(axis.angle) : 0.0) * upright;
                if (tau.norm() > rounding * upright.norm()) {
                    for (std::size_t j = 0; j < joints.size(); ++j) {
                        columns[j].col(c == 0 ? static_cast<Eigen::Index>(a) : moment) =
                            tau.col(static_cast<Eigen::Index>(j)) / std::sin(axis.angle);
                    }
                }
                moment += c == 0 ? 0 : 1;
            }
        }
        for (std::size_t j = 0; j < joints.size(); ++j) {
            columns[j] = rows_of(log, static_cast<int>(j), columns[j]);
        }
        return columns;
    }

  private:
    static Eigen::MatrixXd parameters_in(const idim_model_interface& turned, const Eigen::VectorXd& links,
                                         const Eigen::MatrixXd& unseen) {
        const Eigen::MatrixXd B = links_of(turned);
        const Eigen::BDCSVD<Eigen::MatrixXd> svd(B * unseen, Eigen::ComputeThinU | Eigen::ComputeThinV);
        const Eigen::Index shown = (svd.singularValues().array() > rounding * B.norm()).count();
        Eigen::MatrixXd chi(B.rows(), 1 + shown);
        chi << B * links, svd.matrixU().leftCols(shown);
        return chi;
    }

    const idim_model_interface& model_;
    Eigen::VectorXd rigid_;
    std::vector<turned_parameters> axes_;
};

}  // namespace

candidate_pointer tilt_candidate(const idim_model_interface& model, const std::vector<turned_model>& turned,
                                 const Eigen::VectorXd& chi) {
    return turned.empty() || model.n_signals > model.dof ? nullptr
                                                         : std::make_shared<turned_gravity>(model, turned, chi);
}

}  // namespace idim
