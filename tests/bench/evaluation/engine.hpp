#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "oracles/joint_state.hpp"
#include "oracles/mdh_row.hpp"
#include "oracles/rigid_link.hpp"

namespace idim::bench {

using row_major = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Motion of many samples, one a row.
struct motion_samples {
    Eigen::MatrixXd q, qd, qdd;  ///< [samples x joints]
};

/// One way to evaluate the dynamics of the rigid links of a serial robot. Everything that can be set up once is set up
/// by the constructor.
class engine {
  public:
    virtual ~engine() = default;
    virtual std::string name() const = 0;
    virtual void inverse_dynamics(const test::joint_state& state, Eigen::VectorXd& tau) = 0;
    virtual void mass_matrix(const Eigen::VectorXd& q, row_major& M) = 0;
    virtual void forward_dynamics(const test::joint_state& state, const Eigen::VectorXd& tau, Eigen::VectorXd& qdd) = 0;
    /// Columns of the engine's own parameters. Returns false where it has no regressor.
    virtual bool regressor(const test::joint_state&, row_major&) { return false; }
    /// The same of many samples at once: tau [samples x joints], W [samples x joints * parameters]. False where there
    /// is no such form.
    virtual bool inverse_dynamics(const motion_samples&, Eigen::MatrixXd&) { return false; }
    virtual bool regressor(const motion_samples&, Eigen::MatrixXd&) { return false; }
    /// Parameters that the columns of its regressor belong to.
    virtual Eigen::VectorXd parameters() const { return {}; }
};

struct rigid_robot {
    std::string name;
    test::mdh_table table;
    std::vector<test::rigid_link> links;
};

std::unique_ptr<engine> generated_engine(const rigid_robot& robot);
std::unique_ptr<engine> kdl_engine(const rigid_robot& robot);
std::unique_ptr<engine> mujoco_engine(const rigid_robot& robot);
/// Textbook recursive Newton-Euler over Eigen's fixed-size vectors.
std::unique_ptr<engine> eigen_engine(const rigid_robot& robot);

}  // namespace idim::bench
