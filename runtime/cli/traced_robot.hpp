#pragma once

#include <functional>

#include "identification.hpp"
#include "idim/effect_trace.hpp"
#include "turned_robot.hpp"

namespace idim::cli {

/// What diagnose and refine are asked for.
struct trace_options {
    std::string robot;
    std::vector<std::string> logs;
    std::vector<std::string> validation;
    std::string method = "wls";
    filter_request filter;
    std::string json_file;
};

/// A robot, its filtered logs and the catalogue of effects: everything a trace needs.
struct traced_robot {
    loaded_robot robot;
    compiled_effects effects;
    std::vector<turned_robot> turned;
    filter_choice filter;
    std::vector<filtered_samples> fitted;
    std::vector<filtered_samples> held_back;
    std::vector<effect_place> declared;
    std::string held_back_note;  ///< how data was held back where none was given; empty if it was

    trace_input input() const;
};

/// Options that diagnose and refine share.
void add_trace_options(CLI::App& command, trace_options& options);

/// Reads, filters, and holds data back where no log was given for validation: the last third of every log.
traced_robot load_traced_robot(const trace_options& options);

/// The same logs with another description of the same robot.
traced_robot with_description(const traced_robot& before, const std::string& robot_file);

/// Name of a joint of the model.
std::string joint_name(const loaded_robot& robot, int joint);

}  // namespace idim::cli
