#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "generator.hpp"
#include "idim/compiled_model.hpp"
#include "oracles/joint_state.hpp"
#include "oracles/text_value.hpp"

struct idim_test_interface;

namespace idim::test {

/// As the generated code lays out its matrices.
using row_major = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A robot's model, generated in memory, compiled and loaded, with its functions over Eigen vectors.
class test_model {
  public:
    explicit test_model(const std::string& robot_file);

    const generator::generated_model& generated() const { return generated_; }
    const idim_model_interface& interface() const { return compiled_.interface(); }
    Eigen::Index dof() const { return interface().dof; }
    Eigen::Index n_base() const { return interface().n_base; }
    std::vector<std::string> standard_names() const;
    std::vector<std::string> parameter_names() const;

    /// regroup() of the generated code; names that `standard` does not have are zero.
    Eigen::VectorXd regroup(const value_table& standard) const;

    Eigen::MatrixXd regressor(const joint_state& state, double t = 0.0, const Eigen::VectorXd& temp = {}) const;
    Eigen::VectorXd inverse_dynamics(const joint_state& state, const Eigen::VectorXd& chi, double t = 0.0,
                                     const Eigen::VectorXd& temp = {}) const;
    Eigen::VectorXf inverse_dynamics_float(const joint_state& state, const Eigen::VectorXd& chi) const;
    Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q, const Eigen::VectorXd& chi) const;
    Eigen::VectorXd bias(const joint_state& state, const Eigen::VectorXd& chi, double t = 0.0,
                         const Eigen::VectorXd& temp = {}) const;
    Eigen::VectorXd gravity(const Eigen::VectorXd& q, const Eigen::VectorXd& chi) const;
    /// Accelerations at the state's q and qd; `pivot` receives what the model returns.
    Eigen::VectorXd forward_dynamics(const joint_state& state, const Eigen::VectorXd& tau, const Eigen::VectorXd& chi,
                                     int& pivot, double t = 0.0, const Eigen::VectorXd& temp = {}) const;

  private:
    const idim_test_interface& extended() const;

    generator::generated_model generated_;
    compiled_model compiled_;
};

/// Largest difference of two arrays relative to the largest element of `expected`, which counts as 1e-3 at least.
/// Infinite where an element is not a number.
template <class A, class B>
double deviation(const A& actual, const B& expected) {
    if (!actual.allFinite() || !expected.allFinite()) {
        return std::numeric_limits<double>::infinity();
    }
    return (actual - expected).cwiseAbs().maxCoeff() / std::max(1e-3, expected.cwiseAbs().maxCoeff());
}

}  // namespace idim::test
