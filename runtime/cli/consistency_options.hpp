#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "idim/consistent_fit.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// What the user asks of --method cwls, as text.
struct consistency_options {
    std::string consistency = "full";
    std::string objective = "weighted";
    std::vector<std::string> mass_bounds;  ///< "0.5:5", "j3=0.5:5"
    std::string total_mass;                ///< "15:18"
    std::vector<std::string> com_boxes;    ///< "-0.1:0.1,-0.1:0.1,0:0.3", "j3=..."
    std::string prior;                     ///< a file
    double prior_strength = 0.0;
    std::optional<double> floor;
};

void add_consistency_options(CLI::App& command, consistency_options& options);

/// Links, payloads and effects whose coefficients have a smallest value.
physical_parameters physical_parameters_of(const loaded_robot& robot);

/// Throws input_error where an option cannot be read, names a joint without a link of mass, or the prior lacks a
/// parameter.
consistency_request request_of(const consistency_options& options, const loaded_robot& robot,
                               const physical_parameters& known);

}  // namespace idim::cli
