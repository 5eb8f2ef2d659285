#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "model_candidates.hpp"
#include "swing_search.hpp"

namespace idim {

namespace {

/// The torque of a link that swings, less that of one that moves as its motor, at all joints.
class soft_joint final : public effect_candidate {
  public:
    soft_joint(const idim_model_interface& model, int joint, bool rotor_is_lumped)
        : model_(model), joint_(joint), rotor_is_lumped_(rotor_is_lumped) {
        effect = "joint_elasticity";
        states = 2;
        joints = {joint};
        for (int j = 0; j < model.dof; ++j) {
            touched.push_back(j);
        }
        linear_bound whole = {"share", "1"};
        whole.is_one = true;
        linear = {whole};
        constexpr double any = std::numeric_limits<double>::infinity();
        shape = {{"K", "N*m/rad", 0.0, any}, {"D", "N*m*s/rad", 0.0, any}};
        if (rotor_is_lumped) {
            shape.push_back({"rotor", "kg*m^2", -any, any});
            shape.back().is_nuisance = true;
        }
    }

    Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const override {
        return rows_of(log, joint, twist_torques(model_, log, joint_, at).col(joint));
    }
    std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd& at) const override {
        const Eigen::MatrixXd changed = twist_torques(model_, log, joint_, at);
        std::vector<Eigen::MatrixXd> columns;
        for (const int joint : touched) {
            columns.push_back(rows_of(log, joint, changed.col(joint)));
        }
        return columns;
    }
    /// The same for the inertias of the logs as they are by then.
    candidate_pointer relinearised(const Eigen::VectorXd& /*found*/) const override {
        return std::make_shared<soft_joint>(model_, joint_, rotor_is_lumped_);
    }
    std::vector<Eigen::VectorXd> starts(const trace_fit& fit) const override {
        const swing_search search = search_in(fit);
        if (!search.can_swing()) {
            return {Eigen::VectorXd::Unit(static_cast<Eigen::Index>(shape.size()), 0)};  // columns of zeros
        }
        return {search.best()};
    }
    int shapes_tried(const trace_fit& fit) const override { return search_in(fit).shapes(); }
    Eigen::VectorXd shape_near(const trace_fit& fit, const Eigen::VectorXd& at) const override {
        const swing_search search = search_in(fit);
        return search.can_swing() ? search.refined(at) : at;
    }

  private:
    swing_search search_in(const trace_fit& fit) const { return {model_, fit, joint_, rotor_is_lumped_}; }

    const idim_model_interface& model_;
    int joint_;
    bool rotor_is_lumped_;
};

}  // namespace

candidate_pointer elasticity_candidate(const idim_model_interface& model, int joint, bool rotor_is_lumped) {
    return std::make_shared<soft_joint>(model, joint, rotor_is_lumped);
}

}  // namespace idim
