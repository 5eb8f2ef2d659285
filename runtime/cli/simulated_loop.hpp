#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "idim/loop_identification.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// What the user may say of the loop that an identification simulates.
struct loop_request {
    bool track = false;                    ///< follow the measured position, whatever law is declared
    std::optional<double> bandwidth = {};  ///< of the tracking loop [Hz]
    double bandwidth_scale = 1.0;          ///< simulated over declared natural frequency
};

/// Options --track, --bandwidth, --bandwidth-scale.
void add_loop_options(CLI::App& command, loop_request& request);

/// The loops of one robot and its logs: `rescaled` has its velocity gain recomputed from the inertia of the present
/// parameters, so that the simulated bandwidth stays that of the robot [IV 46]; `fixed` keeps the robot's own gains, as
/// cloe needs them.
struct simulated_loops {
    closed_loop rescaled, fixed;
};

/// Simulates the declared control law along the recorded references. Without a law, or where a log has no reference (or
/// with request.track), the loop follows the filtered measured position with a chosen bandwidth instead, by a cascade
/// with velocity feed-forward, and says so. `a_priori`: parameters near the robot's, which give the inertia where only
/// gains or only a bandwidth are declared. The robot must outlive the result.
simulated_loops simulated_loops_of(const loaded_robot& robot, const std::string& robot_file,
                                   const std::vector<idim::log>& logs, const filter_choice& filter,
                                   const loop_request& request, const Eigen::VectorXd& a_priori);

}  // namespace idim::cli
