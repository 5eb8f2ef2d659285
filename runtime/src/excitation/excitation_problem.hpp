#pragma once

#include <Eigen/Core>
#include <vector>

#include "excitation/gram_criterion.hpp"
#include "idim/excitation_search.hpp"
#include "idim/motion_limits.hpp"

namespace idim {

/// How sharp the smooth forms are.
struct smoothing {
    double power = 2.0;       ///< of eigenvalues
    double sharpness = 50.0;  ///< of the mean of exponentials
};

/// Value, constraints (0 or less where kept) and their derivatives at one motion.
struct problem_value {
    double objective = 0.0;
    Eigen::VectorXd gradient;     ///< [v]
    Eigen::VectorXd constraints;  ///< [m]
    Eigen::MatrixXd jacobian;     ///< v x m, a column for each constraint
    double figure = 0.0;          ///< as in gram_value
    double breach = 0.0;          ///< largest share beyond a limit at the samples
};

/// The search for a motion as a nonlinear program. The v = n (1 + 2 h) variables are, joint by joint, mean, sines and
/// cosines, each divided by the largest that the limits allow it.
class excitation_problem {
  public:
    excitation_problem(const limited_robot& robot, double period, const search_options& options);

    Eigen::Index variables() const { return robot_.model.dof * width_; }
    Eigen::Index constraints() const;
    problem_value evaluate(const Eigen::VectorXd& u, const smoothing& form) const;
    /// Figure and breach alone.
    problem_value figure(const Eigen::VectorXd& u) const;
    fourier_series series(const Eigen::VectorXd& u) const;
    /// A motion around `rest`, its shape drawn from `shape` [v, each in -1..1] and reduced until it keeps the limits,
    /// or to nothing.
    Eigen::VectorXd start(const Eigen::VectorXd& rest, const Eigen::VectorXd& shape) const;
    /// u with all of the motion around `rest` reduced.
    Eigen::VectorXd reduced(const Eigen::VectorXd& u, const Eigen::VectorXd& rest, double factor) const;

  private:
    motion_samples motion(const Eigen::VectorXd& u) const;
    Eigen::VectorXd at(const Eigen::VectorXd& rest) const;
    gram_value criterion(const Eigen::MatrixXd& W, double power) const;
    void add_joint_limits(const motion_samples& motion, const smoothing& form, problem_value& value) const;
    void add_boxes(const motion_samples& motion, const smoothing& form, problem_value& value) const;
    void add_model(const motion_samples& motion, const smoothing& form, problem_value& value) const;

    const limited_robot& robot_;
    const double period_;
    const excitation_criterion criterion_;
    const int harmonics_;
    const Eigen::Index width_;                  ///< variables of a joint
    Eigen::VectorXd t_;                         ///< [N]
    std::array<Eigen::MatrixXd, 3> basis_;      ///< N x width: of q, qd, qdd
    Eigen::MatrixXd scale_;                     ///< width x n
    std::vector<Eigen::Index> torque_limited_;  ///< joints
};

}  // namespace idim
