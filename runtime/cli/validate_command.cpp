#include <fmt/format.h>

#include "identified_parameters.hpp"
#include "idim/log_parameters.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

namespace {

struct validate_options {
    std::string robot;
    std::string result;
    std::vector<std::string> logs;
    filter_request filter;
    std::string json_file;
};

/// Filters as the parameters were identified, unless the user says otherwise.
filter_choice filter_for(const validate_options& options, const identified_parameters& parameters,
                         const std::vector<idim::log>& logs) {
    const filter_request& asked = options.filter;
    if (parameters.filter && !asked.cutoff && !asked.order && !asked.decimation && !asked.minimum_speed) {
        return *parameters.filter;
    }
    return choose_filter(logs, asked);
}

int run(const validate_options& options) {
    const loaded_robot robot = load_robot(options.robot);
    const identified_parameters parameters = read_parameters(options.result, robot);
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const filter_choice filter = filter_for(options, parameters, logs);
    const observation all = with_log_columns(robot.model(), observe_logs(robot, logs, filter, parameters.chi));
    const Eigen::VectorXd chi = with_log_parameters(robot.model(), all, parameters.chi);
    const error_summary total = errors(all, chi);
    json content = to_json(total, robot);
    content["robot"] = robot.generated.robot;
    content["filter"] = to_json(filter);
    content["logs"] = json::array();
    if (prints_text(options.json_file)) {
        fmt::print("{}: {} validated on {} rows\n  {}\n", robot.generated.robot, options.result, all.rows(),
                   filter.reason);
        print(total, robot);
    }
    for (const observation_block& block : all.blocks) {
        const error_summary one = errors({{block}, all.dof, all.n_base}, chi);
        json entry = {{"log", block.file}};
        entry.update(to_json(one, robot));
        content["logs"].push_back(entry);
        if (prints_text(options.json_file) && all.blocks.size() > 1) {
            fmt::print("  {}:", block.file);
            print(one, robot);
        }
    }
    write_json(options.json_file, content);
    return exit_done;
}

}  // namespace

void add_validate_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<validate_options>();
    CLI::App* command = app.add_subcommand("validate", "errors of an identified model on other data");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("result", options->result, "result of identify --json, or a map of parameter names to values")
        ->required();
    command->add_option("logs", options->logs, "logs (.csv, .csv.gz)")->required();
    add_filter_options(*command, options->filter);
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
