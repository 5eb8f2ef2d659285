#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "evaluation/engine.hpp"
#include "oracles/kdl_robot.hpp"

namespace idim::bench {

namespace {

class orocos : public engine {
  public:
    explicit orocos(const rigid_robot& robot)
        : chain_(test::kdl_robot(robot.table, robot.links).chain()),
          gravity_(robot.table.gravity[0], robot.table.gravity[1], robot.table.gravity[2]),
          inverse_(chain_, gravity_),
          inertia_(chain_, gravity_),
          forward_(chain_, gravity_),
          M_(static_cast<int>(chain_.getNrOfJoints())),
          q_(chain_.getNrOfJoints()),
          qd_(q_),
          qdd_(q_),
          tau_(q_),
          none_(chain_.getNrOfSegments()) {}

    std::string name() const override { return "Orocos KDL"; }

    void inverse_dynamics(const test::joint_state& s, Eigen::VectorXd& tau) override {
        q_.data = s.q;
        qd_.data = s.qd;
        qdd_.data = s.qdd;
        inverse_.CartToJnt(q_, qd_, qdd_, none_, tau_);
        tau = tau_.data;
    }
    void mass_matrix(const Eigen::VectorXd& q, row_major& M) override {
        q_.data = q;
        inertia_.JntToMass(q_, M_);
        M = M_.data;
    }
    void forward_dynamics(const test::joint_state& s, const Eigen::VectorXd& tau, Eigen::VectorXd& qdd) override {
        q_.data = s.q;
        qd_.data = s.qd;
        tau_.data = tau;
        forward_.CartToJnt(q_, qd_, tau_, none_, qdd_);
        qdd = qdd_.data;
    }

  private:
    KDL::Chain chain_;
    KDL::Vector gravity_;
    KDL::ChainIdSolver_RNE inverse_;
    KDL::ChainDynParam inertia_;
    KDL::ChainFdSolver_RNE forward_;
    KDL::JntSpaceInertiaMatrix M_;
    KDL::JntArray q_, qd_, qdd_, tau_;
    KDL::Wrenches none_;
};

}  // namespace

std::unique_ptr<engine> kdl_engine(const rigid_robot& robot) {
    return std::make_unique<orocos>(robot);
}

}  // namespace idim::bench
