#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "../link_swing.hpp"
#include "idim/model_interface.h"
#include "trace_fit.hpp"
#include "traced_log.hpp"

namespace idim {

/// What the twist of one transmission changes in the torque of every joint [samples x n]. `shape` is K [N*m/rad],
/// D [N*m*s/rad] and, where the present model counts the rotor as part of the link, its inertia [kg*m^2].
Eigen::MatrixXd twist_torques(const idim_model_interface& model, const traced_log& log, int joint,
                              const Eigen::VectorXd& shape);

/// How the loss of a fit falls with the shape of one soft transmission.
class swing_search {
  public:
    /// `rotor_is_lumped`: the inertia of the rotor is part of the link's and is searched as the third of the shape.
    swing_search(const idim_model_interface& model, const trace_fit& fit, int joint, bool rotor_is_lumped);

    bool can_swing() const { return least_inertia_ > 0.0; }
    /// How many shapes of the grid differ.
    int shapes() const;
    /// The best of a grid by the largest part of the columns, refined by the columns themselves where that is
    /// promising.
    Eigen::VectorXd best() const;
    /// The best near a shape, by the columns themselves.
    Eigen::VectorXd refined(const Eigen::VectorXd& start) const;

  private:
    struct search_point;

    Eigen::VectorXd shape_at(const search_point& at) const;
    search_point point_of(const Eigen::VectorXd& shape) const;
    std::vector<double> frequencies() const;
    std::vector<double> rotor_shares() const;
    double quick_gain(const Eigen::VectorXd& shape) const;
    double exact_gain(const Eigen::VectorXd& shape) const;
    template <class RowsOfLog>
    double gain_by(const RowsOfLog& rows_of_log) const;

    const idim_model_interface& model_;
    const trace_fit& fit_;
    int joint_;
    bool rotor_is_lumped_;
    std::vector<std::size_t> logs_;  ///< those that are fitted
    double mean_inertia_ = 0.0;
    double least_inertia_ = std::numeric_limits<double>::infinity();
    double fastest_ = std::numeric_limits<double>::infinity();
};

}  // namespace idim
