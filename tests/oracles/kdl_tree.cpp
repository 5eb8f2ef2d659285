#include "oracles/kdl_tree.hpp"

#include <urdf_parser/urdf_parser.h>

#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <stdexcept>

namespace idim::test {

namespace {

KDL::Vector urdf_to_kdl(const urdf::Vector3& v) {
    return {v.x, v.y, v.z};
}

KDL::Frame urdf_to_kdl(const urdf::Pose& given) {
    const urdf::Rotation& r = given.rotation;
    return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), urdf_to_kdl(given.position)};
}

KDL::RigidBodyInertia inertia_of_urdf(const urdf::Link& link) {
    if (!link.inertial) {
        return KDL::RigidBodyInertia::Zero();
    }
    const urdf::Inertial& given = *link.inertial;
    const KDL::Frame origin = urdf_to_kdl(given.origin);
    const KDL::RigidBodyInertia central(
        given.mass, KDL::Vector::Zero(),
        KDL::RotationalInertia(given.ixx, given.iyy, given.izz, given.ixy, given.ixz, given.iyz));
    return origin * central;
}

KDL::Joint joint_of_urdf(const urdf::Joint& joint) {
    const KDL::Frame origin = urdf_to_kdl(joint.parent_to_joint_origin_transform);
    switch (joint.type) {
        case urdf::Joint::REVOLUTE:
        case urdf::Joint::CONTINUOUS:
            return KDL::Joint(joint.name, origin.p, origin.M * urdf_to_kdl(joint.axis), KDL::Joint::RotAxis);
        case urdf::Joint::PRISMATIC:
            return KDL::Joint(joint.name, origin.p, origin.M * urdf_to_kdl(joint.axis), KDL::Joint::TransAxis);
        case urdf::Joint::FIXED:
            return KDL::Joint(joint.name, KDL::Joint::None);
        default:
            throw std::runtime_error("joint " + joint.name + " has a type that KDL does not know");
    }
}

void add_below(const urdf::Link& link, KDL::Tree& tree) {
    for (const urdf::LinkSharedPtr& child : link.child_links) {
        const urdf::Joint& joint = *child->parent_joint;
        const KDL::Segment segment(child->name, joint_of_urdf(joint),
                                   urdf_to_kdl(joint.parent_to_joint_origin_transform), inertia_of_urdf(*child));
        if (!tree.addSegment(segment, link.name)) {
            throw std::runtime_error("KDL does not take segment " + child->name);
        }
        add_below(*child, tree);
    }
}

}  // namespace

kdl_tree::kdl_tree(const std::string& urdf, std::vector<std::string> joints) {
    const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
    tree_ = KDL::Tree(model->getRoot()->name);
    add_below(*model->getRoot(), tree_);
    for (const std::string& joint : joints) {
        const auto element = tree_.getSegment(model->getJoint(joint)->child_link_name);
        number_.push_back(static_cast<Eigen::Index>(GetTreeElementQNr(element->second)));
    }
    if (joints.size() != tree_.getNrOfJoints()) {
        throw std::runtime_error("expected the names of " + std::to_string(tree_.getNrOfJoints()) + " joints");
    }
}

Eigen::VectorXd kdl_tree::inverse_dynamics(const joint_state& state) const {
    return torque(state, 9.81);
}

Eigen::MatrixXd kdl_tree::mass_matrix(const Eigen::VectorXd& q) const {
    const Eigen::Index n = q.size();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd M(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
        M.col(j) = torque({q, none, Eigen::VectorXd::Unit(n, j)}, 0.0);
    }
    return M;
}

Eigen::VectorXd kdl_tree::torque(const joint_state& state, double gravity) const {
    const auto reordered = [this](const Eigen::VectorXd& values) {
        KDL::JntArray array(tree_.getNrOfJoints());
        for (std::size_t j = 0; j < number_.size(); ++j) {
            array.data[number_[j]] = values[static_cast<Eigen::Index>(j)];
        }
        return array;
    };
    KDL::TreeIdSolver_RNE solver(tree_, {0.0, 0.0, -gravity});
    KDL::JntArray found(tree_.getNrOfJoints());
    if (solver.CartToJnt(reordered(state.q), reordered(state.qd), reordered(state.qdd), {}, found) < 0) {
        throw std::runtime_error("KDL: inverse dynamics failed");
    }
    Eigen::VectorXd result(state.q.size());
    for (std::size_t j = 0; j < number_.size(); ++j) {
        result[static_cast<Eigen::Index>(j)] = found.data[number_[j]];
    }
    return result;
}

}  // namespace idim::test
