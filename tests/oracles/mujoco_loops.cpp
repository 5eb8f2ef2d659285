#include "oracles/mujoco_loops.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "oracles/mujoco_inertial.hpp"
#include "support/temporary_folder.hpp"

namespace idim::test {

namespace {

constexpr double largest_gap = 1e-13;  // [m], of points within a metre or two

Eigen::Isometry3d frame_of(const mdh_row& row) {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.rotate(Eigen::AngleAxisd(row.gamma, Eigen::Vector3d::UnitZ()));
    frame.translate(Eigen::Vector3d(0.0, 0.0, row.b));
    frame.rotate(Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX()));
    frame.translate(Eigen::Vector3d(row.d, 0.0, 0.0));
    frame.rotate(Eigen::AngleAxisd(row.theta, Eigen::Vector3d::UnitZ()));
    frame.translate(Eigen::Vector3d(0.0, 0.0, row.r));
    return frame;
}

std::string numbers(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) {
        text += fmt::format(" {:.17g}", value);
    }
    return text;
}

/// The body of a row with all that hang on it.
std::string body(const std::vector<tree_row>& rows, const std::vector<rigid_link>& links, std::size_t j) {
    const Eigen::Isometry3d frame = frame_of(rows[j].row);
    const Eigen::Vector3d p = frame.translation();
    const Eigen::Quaterniond turned(frame.linear());
    std::string text = fmt::format(
        "<body name=\"b{}\" pos=\"{}\" quat=\"{}\">\n<joint name=\"j{}\" type=\"{}\" axis=\"0 0 {}\"/>\n{}\n", j,
        numbers({p.x(), p.y(), p.z()}), numbers({turned.w(), turned.x(), turned.y(), turned.z()}), j,
        rows[j].row.prismatic ? "slide" : "hinge", rows[j].row.rate, mujoco_inertial(links[j]));
    for (std::size_t k = 0; k < rows.size(); ++k) {
        text += rows[k].antecedent == static_cast<int>(j) ? body(rows, links, k) : "";
    }
    return text + "</body>\n";
}

mjModel* load_tree(const std::array<double, 3>& gravity, const std::vector<tree_row>& rows,
                   const std::vector<rigid_link>& links) {
    std::string text = "<mujoco><compiler angle=\"radian\"/><option gravity=\"" +
                       numbers({gravity[0], gravity[1], gravity[2]}) +
                       "\"><flag constraint=\"disable\" passive=\"disable\"/></option><worldbody>\n";
    for (std::size_t j = 0; j < rows.size(); ++j) {
        text += rows[j].antecedent < 0 ? body(rows, links, j) : "";
    }
    const temporary_folder folder;
    std::array<char, 500> error = {};
    mjModel* model = mj_loadXML(folder.write("robot.xml", text + "</worldbody></mujoco>\n").c_str(), nullptr,
                                error.data(), static_cast<int>(error.size()));
    if (model == nullptr) {
        throw std::runtime_error(std::string("MuJoCo: ") + error.data());
    }
    return model;
}

int body_of(int link, const mjModel* model) {
    return link < 0 ? 0 : mj_name2id(model, mjOBJ_BODY, fmt::format("b{}", link).c_str());
}

}  // namespace

mujoco_loops::mujoco_loops(const std::array<double, 3>& gravity, const std::vector<tree_row>& rows,
                           const std::vector<rigid_link>& links, const std::vector<held_points>& loops)
    : model_(load_tree(gravity, rows, links), mj_deleteModel),
      data_(mj_makeData(model_.get()), mj_deleteData),
      loops_(loops) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
        const int id = mj_name2id(model_.get(), mjOBJ_JOINT, fmt::format("j{}", j).c_str());
        address_.push_back(model_->jnt_dofadr[id]);
        const bool is_passive = std::any_of(loops.begin(), loops.end(), [j](const held_points& loop) {
            return loop.passive[0] == static_cast<int>(j) || loop.passive[1] == static_cast<int>(j);
        });
        (is_passive ? passive_ : active_).push_back(static_cast<Eigen::Index>(j));
    }
}

void mujoco_loops::place(const Eigen::VectorXd& all) const {
    for (std::size_t j = 0; j < address_.size(); ++j) {
        data_->qpos[address_[j]] = all[static_cast<Eigen::Index>(j)];
    }
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
}

Eigen::Vector3d mujoco_loops::point(const held_points& loop, std::size_t side) const {
    using row_major_rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const int body = body_of(loop.links[side], model_.get());
    return Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body) +
           Eigen::Map<const row_major_rotation>(data_->xmat + 9 * body) * loop.points[side];
}

Eigen::VectorXd mujoco_loops::gaps() const {
    Eigen::VectorXd result(3 * static_cast<Eigen::Index>(loops_.size()));
    for (std::size_t i = 0; i < loops_.size(); ++i) {
        result.segment<3>(3 * static_cast<Eigen::Index>(i)) = point(loops_[i], 0) - point(loops_[i], 1);
    }
    return result;
}

Eigen::MatrixXd mujoco_loops::jacobian() const {
    using row_major_jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::MatrixXd result(3 * static_cast<Eigen::Index>(loops_.size()), model_->nv);
    for (std::size_t i = 0; i < loops_.size(); ++i) {
        std::array<row_major_jacobian, 2> of_side = {row_major_jacobian(3, model_->nv),
                                                     row_major_jacobian(3, model_->nv)};
        for (std::size_t side = 0; side < 2; ++side) {
            const Eigen::Vector3d at = point(loops_[i], side);
            mj_jac(model_.get(), data_.get(), of_side[side].data(), nullptr, at.data(),
                   body_of(loops_[i].links[side], model_.get()));
        }
        result.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = (of_side[0] - of_side[1])(Eigen::all, address_);
    }
    return result;
}

bool mujoco_loops::has_sense() const {
    return std::all_of(loops_.begin(), loops_.end(), [this](const held_points& loop) {
        std::array<Eigen::Vector3d, 2> corners;
        for (std::size_t i = 0; i < 2; ++i) {
            corners[i] = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body_of(loop.passive[i], model_.get()));
        }
        if (loop.sense == 0) {
            const Eigen::Map<const Eigen::Vector3d> fourth(data_->xpos + 3 * body_of(loop.fourth, model_.get()));
            return (corners[0] + corners[1] - point(loop, 0) - fourth).norm() < 1e-9;
        }
        const double* first = data_->xmat + 9 * body_of(loop.passive[0], model_.get());
        const Eigen::Vector3d axis(first[2], first[5], first[8]);
        const double area = axis.dot((corners[1] - corners[0]).cross(point(loop, 0) - corners[0]));
        return loop.sense * area > 0.0;
    });
}

Eigen::VectorXd mujoco_loops::closed(const Eigen::VectorXd& active, const Eigen::VectorXd& near) const {
    std::mt19937_64 random(3);
    constexpr int starts = 100, steps = 60;
    for (int start = 0; start < starts; ++start) {
        Eigen::VectorXd all(static_cast<Eigen::Index>(address_.size()));
        for (double& angle : all) {
            angle = std::uniform_real_distribution<double>(-3.14, 3.14)(random);
        }
        all = start == 0 && near.size() > 0 ? near : all;
        all(active_) = active;
        place(all);
        for (int k = 0; k < steps && gaps().cwiseAbs().maxCoeff() > largest_gap; ++k) {
            const Eigen::VectorXd step =
                jacobian()(Eigen::all, passive_).completeOrthogonalDecomposition().solve(gaps());
            all(passive_) -= step * std::min(1.0, 0.5 / step.cwiseAbs().maxCoeff());
            place(all);
        }
        if (gaps().cwiseAbs().maxCoeff() <= largest_gap && has_sense()) {
            return all;
        }
    }
    return {};
}

double mujoco_loops::margin(const Eigen::VectorXd& all) const {
    place(all);
    return Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian()(Eigen::all, passive_)).singularValues().minCoeff();
}

Eigen::MatrixXd mujoco_loops::rates(const Eigen::VectorXd& all) const {
    place(all);
    const Eigen::MatrixXd J = jacobian();
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(all.size(), dof());
    G(active_, Eigen::all) = Eigen::MatrixXd::Identity(dof(), dof());
    G(passive_, Eigen::all) =
        -J(Eigen::all, passive_).completeOrthogonalDecomposition().solve(Eigen::MatrixXd(J(Eigen::all, active_)));
    return G;
}

joint_state mujoco_loops::motion(const joint_state& active) const {
    const Eigen::VectorXd q = closed(active.q);
    if (q.size() == 0) {
        throw std::runtime_error("the loops do not close");
    }
    const Eigen::MatrixXd G = rates(q);
    const Eigen::VectorXd qd = G * active.qd;
    const auto moving = [&](double h) -> Eigen::VectorXd {
        place(q + h * qd);
        return jacobian() * qd;
    };
    // Passive joints turn fast near a singular position: steps of a milliradian.
    const double h = 1e-3 / std::max(1.0, qd.cwiseAbs().maxCoeff());
    const Eigen::VectorXd gap = (8.0 * (moving(h) - moving(-h)) - (moving(2.0 * h) - moving(-2.0 * h))) / (12.0 * h);
    place(q);
    Eigen::VectorXd qdd = G * active.qdd;
    qdd(passive_) -= jacobian()(Eigen::all, passive_).completeOrthogonalDecomposition().solve(gap);
    return {q, qd, qdd};
}

Eigen::VectorXd mujoco_loops::inverse_dynamics(const joint_state& active) const {
    const joint_state all = motion(active);
    const Eigen::MatrixXd G = rates(all.q);
    for (std::size_t j = 0; j < address_.size(); ++j) {
        data_->qvel[address_[j]] = all.qd[static_cast<Eigen::Index>(j)];
        data_->qacc[address_[j]] = all.qdd[static_cast<Eigen::Index>(j)];
    }
    mj_inverse(model_.get(), data_.get());
    const Eigen::VectorXd torque = Eigen::Map<const Eigen::VectorXd>(data_->qfrc_inverse, model_->nv)(address_);
    return G.transpose() * torque;
}

double mujoco_loops::energy(const Eigen::VectorXd& active, const Eigen::VectorXd& velocity) const {
    const Eigen::VectorXd q = closed(active);
    Eigen::VectorXd qd(model_->nv);
    qd(address_) = rates(q) * velocity;
    mj_forward(model_.get(), data_.get());
    Eigen::MatrixXd M(model_->nv, model_->nv);  // symmetric: row or column major are the same
    mj_fullM(model_.get(), M.data(), data_->qM);
    double energy = 0.5 * qd.dot(M * qd);
    const Eigen::Map<const Eigen::Vector3d> gravity(model_->opt.gravity);
    for (int body = 1; body < model_->nbody; ++body) {
        energy -= model_->body_mass[body] * gravity.dot(Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * body));
    }
    return energy;
}

mujoco_loops mujoco_loops_of(const generator::robot_description& robot, const std::vector<rigid_link>& links,
                             const std::vector<int>& fourth) {
    value_table names;
    for (const auto& constant : robot.constants) {
        names[constant.name] = text_value(constant.value.text, names);
    }
    const auto value = [&names](const generator::expression_text& text, double q) {
        names["q"] = q;
        return text_value(text.text, names);
    };
    std::vector<tree_row> rows;
    for (const auto& joint : robot.joints) {
        const bool prismatic = joint.type == generator::joint_type::prismatic;
        const generator::expression_text& variable = prismatic ? joint.r : joint.theta;
        const double rate = std::round(1e9 * (value(variable, 1.0) - value(variable, 0.0))) / 1e9;
        if (std::abs(rate) != 1.0) {
            throw std::runtime_error(joint.name + " does not move by q or -q plus a constant");
        }
        mdh_row row;
        row = {value(joint.gamma, 0.0),
               value(joint.b, 0.0),
               value(joint.alpha, 0.0),
               value(joint.d, 0.0),
               value(joint.theta, 0.0),
               value(joint.r, 0.0),
               rate,
               prismatic};
        rows.push_back({joint.antecedent, row});
    }
    std::vector<held_points> loops;
    for (const auto& loop : robot.loops) {
        held_points held;
        for (std::size_t side = 0; side < 2; ++side) {
            const auto& point = loop.cut[side].point;
            held.links[side] = loop.cut[side].link;
            held.points[side] = {value(point[0], 0.0), value(point[1], 0.0), value(point[2], 0.0)};
        }
        held.passive = loop.passive;
        held.sense = static_cast<int>(loop.assembly);
        held.fourth = loops.size() < fourth.size() ? fourth[loops.size()] : -1;
        loops.push_back(held);
    }
    const std::array<double, 3> gravity = {value(robot.gravity[0], 0.0), value(robot.gravity[1], 0.0),
                                           value(robot.gravity[2], 0.0)};
    return {gravity, rows, links, loops};
}

}  // namespace idim::test
