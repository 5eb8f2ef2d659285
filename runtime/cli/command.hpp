#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace idim::cli {

using json = nlohmann::ordered_json;

/// Exit states (FORMATS.md, "Commands").
enum exit_state { exit_done = 0, exit_check_said_no = 1, exit_bad_input = 2, exit_data_cannot_answer = 3 };

/// What a command does once its arguments are read; returns the exit state.
using action = std::function<int()>;

/// Adds one command to the application; `chosen` receives its action when the user calls it.
void add_base_command(CLI::App& app, action& chosen);
void add_generate_command(CLI::App& app, action& chosen);
void add_diff_command(CLI::App& app, action& chosen);
void add_identify_command(CLI::App& app, action& chosen);
void add_validate_command(CLI::App& app, action& chosen);
void add_simulate_command(CLI::App& app, action& chosen);
void add_diagnose_command(CLI::App& app, action& chosen);
void add_refine_command(CLI::App& app, action& chosen);
void add_export_command(CLI::App& app, action& chosen);
void add_excite_command(CLI::App& app, action& chosen);

/// Adds --json FILE (`-` for standard output).
void add_json_option(CLI::App& command, std::string& file);

/// Writes `content` to the file of --json, by renaming a temporary (into a device or pipe); nothing where `file` is
/// empty. "idim_version" is
/// put in front. Throws input_error where it cannot be written.
void write_json(const std::string& file, const json& content);

/// Throws input_error where the file cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);

/// Writes what was noted while reading a file to standard error, one line each.
void print_notes(const std::string& file, const std::vector<std::string>& notes);

/// True where the text for people should be printed: not when the JSON goes to standard output.
bool prints_text(const std::string& json_file);

}  // namespace idim::cli
