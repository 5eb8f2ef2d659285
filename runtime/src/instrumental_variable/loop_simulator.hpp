#pragma once

#include <string>
#include <vector>

#include "idim/loop_identification.hpp"

namespace idim {

/// Simulated motion of all logs, filtered as the measured one was, or why there is none.
struct simulated_motions {
    std::vector<filtered_samples> logs;
    std::string failure;  ///< empty if all could be simulated
};

/// Simulates the logs of an experiment, all cores, and compares with what was recorded.
class loop_simulator {
  public:
    loop_simulator(const loop_experiment& experiment, const closed_loop& loop, const observation& rows);

    /// One motion per log for every chi of `points`: result[point].
    std::vector<simulated_motions> simulate(const std::vector<Eigen::VectorXd>& points) const;
    /// Regressor along the motions on the rows of the measured one, with the measured torque.
    observation regressor_along(const std::vector<filtered_samples>& motions) const;
    /// Torque that was measured less what sampling, differences and filters make of the simulated one beside its model,
    /// Y - (Y_s - W_s chi): rows of the measured regressor for iv. Y - 0 where the simulation gives no torque.
    observation corrected(const observation& regressor, const std::vector<filtered_samples>& motions,
                          const observation& along, const Eigen::VectorXd& chi) const;
    /// Errors and distances of chi, `along` being regressor_along of its motions.
    iteration judge(const Eigen::VectorXd& chi, const std::vector<filtered_samples>& motions,
                    const observation& along) const;

    const std::vector<filtered_samples>& measured() const { return measured_; }
    const idim_model_interface& model() const { return experiment_.model; }
    const loop_experiment& experiment() const { return experiment_; }
    const observation& rows() const { return rows_; }

  private:
    const loop_experiment& experiment_;
    const closed_loop& loop_;
    const observation& rows_;
    std::vector<filtered_samples> measured_, reference_;
    std::vector<row_selection> kept_;
    double transient_;  ///< [s]
};

}  // namespace idim
