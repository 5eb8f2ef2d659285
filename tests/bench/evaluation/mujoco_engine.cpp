#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cstring>
#include <stdexcept>

#include "evaluation/engine.hpp"
#include "oracles/mujoco_inertial.hpp"

namespace idim::bench {

namespace {

Eigen::Isometry3d frame_of(const test::mdh_row& row) {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    return Eigen::Isometry3d(AngleAxisd(row.gamma, Vector3d::UnitZ())) * Eigen::Translation3d(0.0, 0.0, row.b) *
           AngleAxisd(row.alpha, Vector3d::UnitX()) * Eigen::Translation3d(row.d, 0.0, 0.0) *
           AngleAxisd(row.theta, Vector3d::UnitZ()) * Eigen::Translation3d(0.0, 0.0, row.r);
}

std::string xml_of(const rigid_robot& robot) {
    const auto& g = robot.table.gravity;
    std::string text = fmt::format(
        "<mujoco><compiler inertiafromgeom='false' angle='radian'/><option gravity='{} {} {}'>"
        "<flag constraint='disable'/></option><worldbody>",
        g[0], g[1], g[2]);
    for (std::size_t j = 0; j < robot.links.size(); ++j) {
        const Eigen::Isometry3d frame = frame_of(robot.table.rows[j]);
        const Eigen::Quaterniond turn(frame.linear());
        const Eigen::Vector3d p = frame.translation();
        const test::rigid_link& link = robot.links[j];
        text += fmt::format("<body pos='{} {} {}' quat='{} {} {} {}'>", p.x(), p.y(), p.z(), turn.w(), turn.x(),
                            turn.y(), turn.z());
        text += fmt::format("<joint type='{}' axis='0 0 1'/>", robot.table.rows[j].prismatic ? "slide" : "hinge");
        text += test::mujoco_inertial(link);
    }
    for (std::size_t j = 0; j < robot.links.size(); ++j) {
        text += "</body>";
    }
    return text + "</worldbody></mujoco>";
}

/// Loads a model from text through the virtual file system.
mjModel* load(const std::string& xml) {
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

struct free_mujoco {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
};

/// The steps of MuJoCo's pipeline that each model needs, and no others.
class mujoco : public engine {
  public:
    explicit mujoco(const rigid_robot& robot) : model_(load(xml_of(robot))), data_(mj_makeData(model_.get())) {}

    std::string name() const override { return "MuJoCo"; }

    void inverse_dynamics(const test::joint_state& s, Eigen::VectorXd& tau) override {
        set(s);
        std::copy(s.qdd.begin(), s.qdd.end(), data_->qacc);
        mj_kinematics(model_.get(), data_.get());
        mj_comPos(model_.get(), data_.get());
        mj_comVel(model_.get(), data_.get());
        mj_rne(model_.get(), data_.get(), 1, tau.data());
    }
    void mass_matrix(const Eigen::VectorXd& q, row_major& M) override {
        std::copy(q.begin(), q.end(), data_->qpos);
        mj_kinematics(model_.get(), data_.get());
        mj_comPos(model_.get(), data_.get());
        mj_crb(model_.get(), data_.get());
        mj_fullM(model_.get(), M.data(), data_->qM);
    }
    void forward_dynamics(const test::joint_state& s, const Eigen::VectorXd& tau, Eigen::VectorXd& qdd) override {
        set(s);
        mj_kinematics(model_.get(), data_.get());
        mj_comPos(model_.get(), data_.get());
        mj_crb(model_.get(), data_.get());
        mj_factorM(model_.get(), data_.get());
        mj_comVel(model_.get(), data_.get());
        mj_rne(model_.get(), data_.get(), 0, data_->qfrc_bias);
        for (int j = 0; j < model_->nv; ++j) {
            data_->qfrc_smooth[j] = tau[j] - data_->qfrc_bias[j];
        }
        mj_solveM(model_.get(), data_.get(), qdd.data(), data_->qfrc_smooth, 1);
    }

  private:
    void set(const test::joint_state& s) {
        std::copy(s.q.begin(), s.q.end(), data_->qpos);
        std::copy(s.qd.begin(), s.qd.end(), data_->qvel);
    }

    std::unique_ptr<mjModel, free_mujoco> model_;
    std::unique_ptr<mjData, free_mujoco> data_;
};

}  // namespace

std::unique_ptr<engine> mujoco_engine(const rigid_robot& robot) {
    return std::make_unique<mujoco>(robot);
}

}  // namespace idim::bench
