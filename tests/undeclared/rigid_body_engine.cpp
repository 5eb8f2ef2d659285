#include "undeclared/rigid_body_engine.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cstring>
#include <mutex>
#include <stdexcept>

namespace idim::undeclared {

namespace {

/// MuJoCo keeps an inertia as its principal values and the turn of their axes.
struct principal_inertia {
    Eigen::Vector3d values;
    Eigen::Quaterniond turn;
};

principal_inertia principal_of(const Eigen::Matrix3d& inertia) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    axes.col(2) *= axes.determinant() > 0.0 ? 1.0 : -1.0;
    return {solver.eigenvalues(), Eigen::Quaterniond(axes)};
}

std::string body_text(const chain_row& row, const solid& link) {
    const Eigen::Isometry3d frame = Eigen::Isometry3d(Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX())) *
                                    Eigen::Translation3d(row.d, 0.0, 0.0) *
                                    Eigen::AngleAxisd(row.theta, Eigen::Vector3d::UnitZ()) *
                                    Eigen::Translation3d(0.0, 0.0, row.r);
    const Eigen::Quaterniond turn(frame.linear());
    const Eigen::Vector3d p = frame.translation();
    const principal_inertia inertia = principal_of(link.central_inertia);
    return fmt::format(
        "<body pos='{} {} {}' quat='{} {} {} {}'><joint type='{}' axis='0 0 1'/>"
        "<inertial mass='{}' pos='{} {} {}' quat='{} {} {} {}' diaginertia='{} {} {}'/>",
        p.x(), p.y(), p.z(), turn.w(), turn.x(), turn.y(), turn.z(), row.prismatic ? "slide" : "hinge", link.mass,
        link.centre.x(), link.centre.y(), link.centre.z(), inertia.turn.w(), inertia.turn.x(), inertia.turn.y(),
        inertia.turn.z(), inertia.values[0], inertia.values[1], inertia.values[2]);
}

mjModel* load(const arm& robot) {
    static std::mutex one_at_a_time;  // MuJoCo's reader of XML keeps global state
    const std::lock_guard guard(one_at_a_time);
    const Eigen::Vector3d& g = robot.gravity;
    std::string xml = fmt::format(
        "<mujoco><compiler inertiafromgeom='false' angle='radian'/><option gravity='{} {} {}'>"
        "<flag constraint='disable'/></option><worldbody>",
        g[0], g[1], g[2]);
    for (std::size_t j = 0; j < robot.rows.size(); ++j) {
        xml += body_text(robot.rows[j], robot.links[j]);
    }
    for (std::size_t j = 0; j < robot.rows.size(); ++j) {
        xml += "</body>";
    }
    xml += "</worldbody></mujoco>";
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[files->nfile - 1], xml.data(), xml.size());
    char error[1000] = "";
    mjModel* const model = mj_loadXML("robot.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (model == nullptr) {
        throw std::runtime_error(std::string("MuJoCo: ") + error);
    }
    return model;
}

}  // namespace

rigid_body_engine::rigid_body_engine(const arm& robot)
    : model_(load(robot), mj_deleteModel), data_(mj_makeData(model_.get()), mj_deleteData) {}

void rigid_body_engine::set_gravity(const Eigen::Vector3d& gravity) {
    std::copy(gravity.begin(), gravity.end(), model_->opt.gravity);
}

void rigid_body_engine::set_link(int j, const solid& body) {
    const int id = j + 1;  // body 0 is the world
    const principal_inertia inertia = principal_of(body.central_inertia);
    const Eigen::Vector4d turn(inertia.turn.w(), inertia.turn.x(), inertia.turn.y(), inertia.turn.z());
    model_->body_mass[id] = body.mass;
    std::copy(body.centre.begin(), body.centre.end(), model_->body_ipos + 3 * id);
    std::copy(turn.begin(), turn.end(), model_->body_iquat + 4 * id);
    std::copy(inertia.values.begin(), inertia.values.end(), model_->body_inertia + 3 * id);
    model_->body_sameframe[id] = 0;
}

void rigid_body_engine::set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    std::copy(q.begin(), q.end(), data_->qpos);
    std::copy(qd.begin(), qd.end(), data_->qvel);
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
}

void rigid_body_engine::inverse_dynamics(const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                         const Eigen::VectorXd& qdd, Eigen::VectorXd& tau) {
    set(q, qd);
    std::copy(qdd.begin(), qdd.end(), data_->qacc);
    mj_comVel(model_.get(), data_.get());
    tau.resize(dof());
    mj_rne(model_.get(), data_.get(), 1, tau.data());
}

void rigid_body_engine::equations_of_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, joint_matrix& M,
                                            Eigen::VectorXd& N) {
    set(q, qd);
    mj_crb(model_.get(), data_.get());
    M.resize(dof(), dof());
    mj_fullM(model_.get(), M.data(), data_->qM);
    mj_comVel(model_.get(), data_.get());
    N.resize(dof());
    mj_rne(model_.get(), data_.get(), 0, N.data());
}

}  // namespace idim::undeclared
