#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "trace_fit.hpp"

namespace idim {

/// A signal of the robot that a residual may depend on, by its name in reports: "q2", "qd1", "tau1", "temp1", "t".
struct signal_source {
    enum class kind { q, qd, qdd, tau, temp, t };
    kind what = kind::q;
    int joint = 0;

    std::string name() const;
    bool operator==(const signal_source& other) const { return what == other.what && joint == other.joint; }
};

/// Rows of one joint away from reversals, those of all fitted logs or of all held back, one behind the other.
struct joint_residual {
    Eigen::VectorXd left;    ///< weighted residual
    Eigen::MatrixXd model;   ///< weighted columns of everything fitted, combined so that no two tell the same: rows x k
    Eigen::VectorXd weight;  ///< 1 / deviation of every row
    Eigen::MatrixXd signals;  ///< rows x sources, at the rows' own times
};

/// The joint's own motion first, then the others', then torque of the links, temperature and time where they vary.
std::vector<signal_source> sources_for(const trace_fit& fit, int joint);

joint_residual residual_of(const trace_fit& fit, int joint, const std::vector<signal_source>& sources, bool held_back);

}  // namespace idim
