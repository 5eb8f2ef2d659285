#include "oracles/kdl_robot.hpp"

#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <stdexcept>
#include <string>

namespace idim::test {

namespace {

KDL::Joint joint_of(const mdh_row& row, const KDL::Frame& at_zero, std::size_t number) {
    const auto type = row.prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    return {"j" + std::to_string(number), at_zero.p, at_zero.M.UnitZ(), type, row.rate};
}

/// Frame of a link in that of its antecedent at q = 0.
KDL::Frame link_frame(const mdh_row& row) {
    const KDL::Frame before(KDL::Rotation::RotZ(row.gamma), KDL::Vector(0.0, 0.0, row.b));
    return before * KDL::Frame::DH_Craig1989(row.d, row.alpha, row.r, row.theta);
}

KDL::RigidBodyInertia inertia_of(const rigid_link& link) {
    const Eigen::Matrix3d& I = link.central_inertia;
    return KDL::RigidBodyInertia(link.mass, KDL::Vector(link.centre.x(), link.centre.y(), link.centre.z()),
                                 KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
}

KDL::JntArray to_kdl(const Eigen::VectorXd& values) {
    KDL::JntArray array(static_cast<unsigned>(values.size()));
    array.data = values;
    return array;
}

void require(int status, const char* what) {
    if (status < 0) {
        throw std::runtime_error(std::string("KDL: ") + what + " failed with " + std::to_string(status));
    }
}

/// A body whose ten parameters (order of kdl_regressor) are zero but for one; with `index` 10, all. One kilogram at the
/// origin is added, because KDL wants a mass.
rigid_link unit_link(int index) {
    rigid_link link;
    link.mass = index == 9 ? 2.0 : 1.0;
    constexpr int row[6] = {0, 0, 0, 1, 1, 2};
    constexpr int column[6] = {0, 1, 2, 1, 2, 2};
    if (index < 6) {
        link.central_inertia(row[index], column[index]) = link.central_inertia(column[index], row[index]) = 1.0;
    } else if (index < 9) {
        link.centre[index - 6] = 1.0;
        link.central_inertia = link.centre * link.centre.transpose() - Eigen::Matrix3d::Identity();
    }
    return link;
}

}  // namespace

kdl_robot::kdl_robot(const mdh_table& table, const std::vector<rigid_link>& links)
    : gravity_(table.gravity[0], table.gravity[1], table.gravity[2]) {
    for (std::size_t j = 0; j < table.rows.size(); ++j) {
        const KDL::Frame at_zero = link_frame(table.rows[j]);
        chain_.addSegment(KDL::Segment(joint_of(table.rows[j], at_zero, j + 1), at_zero, inertia_of(links.at(j))));
    }
}

Eigen::VectorXd kdl_robot::inverse_dynamics(const joint_state& state) const {
    KDL::ChainIdSolver_RNE solver(chain_, gravity_);
    KDL::JntArray torque(chain_.getNrOfJoints());
    const KDL::Wrenches none(chain_.getNrOfSegments());
    require(solver.CartToJnt(to_kdl(state.q), to_kdl(state.qd), to_kdl(state.qdd), none, torque), "inverse dynamics");
    return torque.data;
}

Eigen::MatrixXd kdl_robot::mass_matrix(const Eigen::VectorXd& q) const {
    KDL::ChainDynParam solver(chain_, gravity_);
    KDL::JntSpaceInertiaMatrix M(static_cast<int>(chain_.getNrOfJoints()));
    require(solver.JntToMass(to_kdl(q), M), "mass matrix");
    return M.data;
}

Eigen::VectorXd kdl_robot::gravity(const Eigen::VectorXd& q) const {
    KDL::ChainDynParam solver(chain_, gravity_);
    KDL::JntArray torque(chain_.getNrOfJoints());
    require(solver.JntToGravity(to_kdl(q), torque), "gravity");
    return torque.data;
}

double kdl_robot::potential_energy(const Eigen::VectorXd& q) const {
    KDL::Frame frame = KDL::Frame::Identity();
    double energy = 0.0;
    for (unsigned j = 0; j < chain_.getNrOfSegments(); ++j) {
        const KDL::Segment& segment = chain_.getSegment(j);
        frame = frame * segment.pose(q[j]);
        energy -= segment.getInertia().getMass() * KDL::dot(gravity_, frame * segment.getInertia().getCOG());
    }
    return energy;
}

Eigen::MatrixXd kdl_regressor(const mdh_table& table, const joint_state& state) {
    const std::size_t n = table.rows.size();
    const std::vector<rigid_link> zero(n, unit_link(10));
    const Eigen::VectorXd offset = kdl_robot(table, zero).inverse_dynamics(state);
    Eigen::MatrixXd W(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(10 * n));
    for (std::size_t j = 0; j < n; ++j) {
        for (int k = 0; k < 10; ++k) {
            std::vector<rigid_link> links = zero;
            links[j] = unit_link(k);
            W.col(static_cast<Eigen::Index>(10 * j) + k) = kdl_robot(table, links).inverse_dynamics(state) - offset;
        }
    }
    return W;
}

}  // namespace idim::test
