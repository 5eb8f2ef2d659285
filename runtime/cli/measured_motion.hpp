#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "command.hpp"
#include "generator.hpp"
#include "idim/compiled_model.hpp"
#include "idim/estimate.hpp"
#include "idim/log.hpp"
#include "idim/stored_log.hpp"

namespace idim::cli {

/// A robot's model, generated, compiled and loaded.
struct loaded_robot {
    generator::generated_model generated;
    compiled_model compiled;

    const idim_model_interface& model() const { return compiled.interface(); }
};

/// Compiles the files of a generated model (or takes them from the cache) and loads them.
compiled_model compile_files(const std::vector<generator::rendered_file>& files, const std::string& input_hash);

/// Generates, compiles (or takes from the cache) and loads the model of a robot description.
loaded_robot load_robot(const std::string& robot_file);

/// The model of a description that stands for another: what is to be known of that one was said already.
compiled_model load_variant(const std::string& robot_file);

/// Generates, compiles (or takes from the cache) and loads the effects that a residual of this robot may be traced to.
compiled_effects load_effects(const std::string& robot_file);

/// Names and drive gains for reading a log of this robot.
log_columns columns_of(const loaded_robot& robot);

/// Reads all logs.
std::vector<idim::log> read_logs(const loaded_robot& robot, const std::vector<std::string>& files);

/// Reads all logs into temporary files.
std::vector<stored_log> store_logs(const loaded_robot& robot, const std::vector<std::string>& files);

/// Joints whose measured position never leaves one value over all logs, by name.
std::vector<std::string> joints_at_rest(const loaded_robot& robot, const std::vector<idim::log>& logs);
std::vector<std::string> joints_at_rest(const loaded_robot& robot, const std::vector<stored_log>& logs);

/// Rows of the identification: filtered, decimated; of parameters `chi` where they depend on these.
observation observe_logs(const loaded_robot& robot, const std::vector<idim::log>& logs, const filter_choice& choice,
                         const Eigen::VectorXd& chi = {});

/// The base parameter of a column of rows.
const generator::parameter_context& parameter_of(const loaded_robot& robot, const observation& rows,
                                                 Eigen::Index column);

/// Its name, with the number of the log behind it where every log has its own: "Ac1@2".
std::string name_of(const loaded_robot& robot, const observation& rows, Eigen::Index column);

/// Options --cutoff, --order, --decimation.
void add_filter_options(CLI::App& command, filter_request& request);

json to_json(const error_summary& errors, const loaded_robot& robot);
json to_json(const filter_choice& choice);
void print(const error_summary& errors, const loaded_robot& robot);

/// A number for JSON: null where it is not finite.
json finite(double value);

}  // namespace idim::cli
