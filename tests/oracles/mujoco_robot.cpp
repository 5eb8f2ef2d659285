#include "oracles/mujoco_robot.hpp"

#include <array>
#include <stdexcept>

#include "support/temporary_folder.hpp"

namespace idim::test {

namespace {

/// A file of its own, because MuJoCo reads no text; its extension inside the URDF keeps inertias and fixed links as
/// they are.
mjModel* load_urdf(std::string urdf) {
    const std::string settings =
        "<mujoco><compiler balanceinertia=\"false\" fusestatic=\"false\" discardvisual=\"true\"/></mujoco>\n";
    urdf.insert(urdf.rfind("</robot>"), settings);
    const temporary_folder folder;
    std::array<char, 500> error = {};
    mjModel* model =
        mj_loadXML(folder.write("robot.urdf", urdf).c_str(), nullptr, error.data(), static_cast<int>(error.size()));
    if (model == nullptr) {
        throw std::runtime_error(std::string("MuJoCo: ") + error.data());
    }
    return model;
}

}  // namespace

mujoco_robot::mujoco_robot(const std::string& urdf, const std::vector<std::string>& joints)
    : model_(load_urdf(urdf), mj_deleteModel), data_(mj_makeData(model_.get()), mj_deleteData) {
    model_->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_PASSIVE;
    for (const std::string& joint : joints) {
        const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.c_str());
        if (id < 0) {
            throw std::runtime_error("MuJoCo has no joint " + joint);
        }
        position_.push_back(model_->jnt_qposadr[id]);
        velocity_.push_back(model_->jnt_dofadr[id]);
    }
    if (static_cast<int>(joints.size()) != model_->nv) {
        throw std::runtime_error("expected the names of " + std::to_string(model_->nv) + " joints");
    }
}

void mujoco_robot::set(const joint_state& state) const {
    for (std::size_t j = 0; j < position_.size(); ++j) {
        data_->qpos[position_[j]] = state.q[static_cast<Eigen::Index>(j)];
        data_->qvel[velocity_[j]] = state.qd[static_cast<Eigen::Index>(j)];
        data_->qacc[velocity_[j]] = state.qdd[static_cast<Eigen::Index>(j)];
    }
    mj_inverse(model_.get(), data_.get());
}

Eigen::VectorXd mujoco_robot::inverse_dynamics(const joint_state& state) const {
    set(state);
    Eigen::VectorXd torque(state.q.size());
    for (std::size_t j = 0; j < velocity_.size(); ++j) {
        torque[static_cast<Eigen::Index>(j)] = data_->qfrc_inverse[velocity_[j]];
    }
    return torque;
}

Eigen::MatrixXd mujoco_robot::mass_matrix(const Eigen::VectorXd& q) const {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
    set({q, zero, zero});
    Eigen::MatrixXd M(model_->nv, model_->nv);  // symmetric: row or column major are the same
    mj_fullM(model_.get(), M.data(), data_->qM);
    return M(velocity_, velocity_);
}

Eigen::VectorXd mujoco_robot::forward_dynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                               const Eigen::VectorXd& tau, const Eigen::VectorXd& rotor) const {
    Eigen::VectorXd qdd(q.size());
    for (std::size_t j = 0; j < position_.size(); ++j) {
        const auto joint = static_cast<Eigen::Index>(j);
        data_->qpos[position_[j]] = q[joint];
        data_->qvel[velocity_[j]] = qd[joint];
        data_->qfrc_applied[velocity_[j]] = tau[joint];
        model_->dof_armature[velocity_[j]] = rotor[joint];
    }
    mj_forward(model_.get(), data_.get());
    for (std::size_t j = 0; j < velocity_.size(); ++j) {
        qdd[static_cast<Eigen::Index>(j)] = data_->qacc[velocity_[j]];
    }
    return qdd;
}

}  // namespace idim::test
