#include <fmt/format.h>
#include <fmt/ranges.h>

#include "consistency_report.hpp"
#include "identification.hpp"
#include "identified_parameters.hpp"
#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "measured_motion.hpp"
#include "method_report.hpp"
#include "method_run.hpp"
#include "streamed_logs.hpp"

namespace idim::cli {

namespace {

struct identify_options {
    std::string robot;
    std::vector<std::string> logs;
    std::string method = "wls";
    bool compare = false;
    method_request simulation;
    filter_request filter;
    bool stream = false;
    std::string truth;
    std::string json_file;
};

bool is_at_bound(const method_result& by, Eigen::Index k) {
    return by.consistent && by.consistent->at_bound[static_cast<std::size_t>(k)];
}

/// A parameter that active constraints hold has no deviation.
void flag_bounds(json& parameters, const consistent_estimate& found) {
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        parameters[k]["at_bound"] = static_cast<bool>(found.at_bound[k]);
        if (found.at_bound[k]) {
            parameters[k]["std"] = nullptr;
            parameters[k]["relative_std_percent"] = nullptr;
        }
    }
}

/// What the scatter of the periods alone says of the parameters.
void add_scatter_deviations(json& parameters, const Eigen::VectorXd& deviations) {
    for (Eigen::Index k = 0; k < deviations.size(); ++k) {
        parameters[static_cast<std::size_t>(k)]["std_of_periods"] = deviations[k];
    }
}

void print_parameters(const identification& found, const method_result& by) {
    const Eigen::VectorXd std = found.result.deviations();
    fmt::print("  {:<10} {:>13} {:>11} {:>8}  {}\n", "parameter", "value", "std", "%", "unit");
    for (Eigen::Index k = 0; k < found.result.chi.size(); ++k) {
        const auto& parameter = parameter_of(found.robot, found.rows, k);
        if (is_at_bound(by, k)) {
            fmt::print("  {:<10} {:>13.6g} {:>11} {:>8}  {}\n", name_of(found.robot, found.rows, k),
                       found.result.chi[k], "at bound", "", parameter.unit);
            continue;
        }
        fmt::print("  {:<10} {:>13.6g} {:>11.3g} {:>8.2f}  {}\n", name_of(found.robot, found.rows, k),
                   found.result.chi[k], std[k], relative_percent(std[k], found.result.chi[k]), parameter.unit);
    }
}

void print_essential(const identification& found) {
    std::vector<std::string> dropped;
    for (const int k : found.essential.dropped) {
        dropped.push_back(name_of(found.robot, found.rows, k));
    }
    fmt::print("  essential: {} of {} parameters, relative error {:.2f} %; without: {}\n", found.essential.kept.size(),
               found.result.chi.size(), 100.0 * found.essential.residual.relative_error,
               dropped.empty() ? "none" : fmt::format("{}", fmt::join(dropped, " ")));
}

void print_identification(const identification& found, const method_result& by,
                          const std::optional<periodic_logs>& periods) {
    const estimate& result = found.result;
    fmt::print("{}: {}, {} rows, condition number {:.3g} ({:.3g} with columns scaled)\n", found.robot.generated.robot,
               by.method, result.samples, result.condition_number, result.scaled_condition_number);
    fmt::print("  {}\n", found.filter.reason);
    if (periods) {
        print(*periods);
    }
    print_iterations(by, found.robot);
    print_parameters(found, by);
    print(result.residual, found.robot);
    fmt::print("  residual correlated over {:.1f} rows (by joint); the deviations account for it\n",
               fmt::join(result.correlation_length, " "));
    print_tests(by, found.robot);
    if (by.consistent) {
        print_consistency(*by.consistent);
    }
    if (has_essential(found)) {
        print_essential(found);
    }
}

/// For simulated logs: how far the estimate is from what was simulated, in its own deviations.
void print_truth(const identification& found, const Eigen::VectorXd& truth) {
    const Eigen::VectorXd std = found.result.deviations();
    fmt::print("  {:<10} {:>13} {:>13} {:>22}\n", "parameter", "truth", "estimate", "error in deviations");
    for (Eigen::Index k = 0; k < truth.size(); ++k) {
        fmt::print("  {:<10} {:>13.6g} {:>13.6g} {:>22.2f}\n", name_of(found.robot, found.rows, k), truth[k],
                   found.result.chi[k], (found.result.chi[k] - truth[k]) / std[k]);
    }
}

/// One line that says what the data lacks.
std::string explain(const identification& found, const std::vector<std::string>& at_rest) {
    std::vector<std::string> names;
    for (const int k : found.result.not_excited) {
        names.push_back(name_of(found.robot, found.rows, k));
    }
    std::string text = fmt::format("the data does not excite {}: rank {} of {}", fmt::join(names, " "),
                                   found.result.rank, found.robot.generated.base.parameters.size());
    if (!at_rest.empty()) {
        text += fmt::format("; joint {} never moves", fmt::join(at_rest, ", "));
    }
    return text;
}

std::string explain_standstill(const loaded_robot& robot, const std::vector<std::string>& at_rest) {
    std::vector<std::string> names;
    for (const auto& parameter : robot.generated.base.parameters) {
        names.push_back(parameter.name);
    }
    return fmt::format("the data does not excite {}: joint {} never moves", fmt::join(names, " "),
                       fmt::join(at_rest, ", "));
}

/// Every method on the same rows, in one table.
int compare(const identify_options& options, const loaded_robot& robot, const filter_choice& filter,
            method_runner& runner) {
    const observation rows = runner.steady_rows();
    std::vector<method_result> results;
    for (const std::string& method : method_names()) {
        results.push_back(runner.run(method, rows));
    }
    write_json(options.json_file, {{"robot", robot.generated.robot},
                                   {"input_hash", robot.generated.input_hash},
                                   {"logs", options.logs},
                                   {"filter", to_json(filter)},
                                   {"samples", rows.rows()},
                                   {"methods", comparison_json(results, robot)}});
    if (prints_text(options.json_file)) {
        fmt::print("{}: methods compared on {} rows\n  {}\n", robot.generated.robot, rows.rows(), filter.reason);
        print_comparison(results, robot);
    }
    return exit_done;
}

/// Averaged periods are rows of least squares; the closed loop is simulated along whole logs.
void check_period_use(const identify_options& options) {
    const bool averages = options.method == "ols" || options.method == "wls" || options.method == "cwls";
    if (!options.simulation.period.empty() && (!averages || options.compare)) {
        throw input_error({"", 0, "--period"},
                          fmt::format("not with {}, expected --method ols, wls or cwls",
                                      options.compare ? "--compare" : "--method " + options.method));
    }
}

/// Whether the logs are read in parts: as asked for, or large ones where that can be done. Throws input_error where it
/// is asked for and cannot.
bool streams(const loaded_robot& robot, const identify_options& options) {
    const std::string obstacle = options.compare
                                     ? "not with --compare, expected --method ols or wls"
                                     : streaming_obstacle(robot, options.method, !options.simulation.period.empty());
    if (options.stream && !obstacle.empty()) {
        throw input_error({"", 0, "--stream"}, obstacle);
    }
    return obstacle.empty() && (options.stream || are_large(options.logs));
}

/// What a run came to.
struct outcome {
    identification found;
    method_result by;
    std::optional<periodic_logs> periods;
    std::vector<std::string> at_rest;
    bool streamed = false;
};

json content_of(const outcome& run, const identify_options& options) {
    const loaded_robot& robot = run.found.robot;
    json content = to_json(run.found, options.method);
    content["streamed"] = run.streamed;
    if (run.periods) {
        content["periodic"] = to_json(*run.periods, robot);
        add_scatter_deviations(content["parameters"], run.by.scatter_deviations);
    }
    content["description"] = options.robot;
    if (run.by.consistent) {
        content["consistency"] = to_json(*run.by.consistent, robot);
        flag_bounds(content["parameters"], *run.by.consistent);
    }
    content["iterations"] = iterations_json(run.by.fit, robot);
    content["loop"] = loop_json(run.by);
    content["tests"] = tests_json(run.by, robot);
    return content;
}

int report(const outcome& run, const identify_options& options, const Eigen::VectorXd& truth) {
    const estimate& result = run.found.result;
    write_json(options.json_file, content_of(run, options));
    if (result.chi.size() == 0) {
        if (prints_text(options.json_file)) {
            print_iterations(run.by, run.found.robot);
        }
        const bool unexcited = !result.not_excited.empty() && result.iterations.empty();
        throw data_error(unexcited ? explain(run.found, run.at_rest) : result.message);
    }
    if (prints_text(options.json_file)) {
        print_identification(run.found, run.by, run.periods);
        if (truth.size() > 0) {
            print_truth(run.found, truth);
        }
    }
    return exit_done;
}

void require_motion(const loaded_robot& robot, const std::vector<std::string>& at_rest) {
    if (at_rest.size() == robot.generated.joints.size()) {
        throw data_error(explain_standstill(robot, at_rest));
    }
}

/// What a method made of rows in memory.
outcome outcome_of(const loaded_robot& robot, const identify_options& options, const filter_choice& filter,
                   method_runner& runner, std::vector<std::string> at_rest) {
    observation rows = simulates(options.method) ? runner.steady_rows() : runner.all_rows();
    method_result by = runner.run(options.method, rows);
    essential_parameters essential;
    // The F test behind it supposes least squares on these rows.
    if (by.fit.chi.size() > 0 && !simulates(options.method) && !by.consistent) {
        essential = find_essential(rows, by.fit);
    }
    identification found{robot, filter, std::move(rows), by.fit, std::move(essential)};
    return {std::move(found), std::move(by), runner.release_periods(), std::move(at_rest)};
}

/// The same of logs that are read in parts.
outcome streamed(const loaded_robot& robot, const identify_options& options) {
    const std::vector<stored_log> logs = store_logs(robot, options.logs);
    std::vector<std::string> at_rest = joints_at_rest(robot, logs);
    require_motion(robot, at_rest);
    const filter_choice filter = choose_filter(logs, options.filter);
    std::optional<periodic_logs> periods;
    if (!options.simulation.period.empty()) {
        periods = find_periods(logs, filter, options.simulation.period);
        if (periods->averages()) {
            method_runner runner(robot, options.robot, std::move(*periods), filter, options.simulation);
            outcome run = outcome_of(robot, options, filter, runner, std::move(at_rest));
            run.streamed = true;
            return run;
        }
        if (const std::string obstacle = streaming_obstacle(robot, options.method, false); !obstacle.empty()) {
            throw input_error({"", 0, "--stream"}, fmt::format("{} ({})", obstacle, periods->obstacle));
        }
    }
    streamed_outcome run = identify_streamed(robot, logs, filter, options.method);
    return {std::move(run.found), std::move(run.by), std::move(periods), std::move(at_rest), true};
}

int run(const identify_options& options) {
    check_period_use(options);
    const loaded_robot robot = load_robot(options.robot);
    const Eigen::VectorXd truth = options.truth.empty() ? Eigen::VectorXd() : read_parameters(options.truth, robot).chi;
    if (streams(robot, options)) {
        return report(streamed(robot, options), options, truth);
    }
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const std::vector<std::string> at_rest = joints_at_rest(robot, logs);
    require_motion(robot, at_rest);
    const filter_choice filter = choose_filter(logs, options.filter);
    method_runner runner(robot, options.robot, logs, filter, options.simulation);
    if (options.compare) {
        return compare(options, robot, filter, runner);
    }
    return report(outcome_of(robot, options, filter, runner, at_rest), options, truth);
}

}  // namespace

void add_identify_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<identify_options>();
    CLI::App* command = app.add_subcommand("identify", "base parameters from measured motion, with deviations");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("logs", options->logs, "logs (.csv, .csv.gz)")->required();
    command
        ->add_option("--method", options->method,
                     "least squares: ols, wls (default), irls (robust), tls (total), cwls (wls with consistent links); "
                     "with the closed loop simulated: iv "
                     "(instrumental variable), didim (output error on the torque), cloe (on the position)")
        ->check(CLI::IsMember(method_names()));
    command->add_flag("--compare", options->compare, "all methods on the same rows, in one table");
    command->add_option("--start", options->simulation.start,
                        "where iv, didim and cloe begin: ls (least squares, default), regular (inertia matrix regular, "
                        "all else 0), or a file of parameters");
    command->add_option("--iterations", options->simulation.options.most_iterations, "at most so many; default 20")
        ->check(CLI::Range(1, 1000));
    command
        ->add_option("--tolerance", options->simulation.options.tolerance,
                     "they end when what the simulated model leaves of the torque changes by less than this part")
        ->check(CLI::PositiveNumber);
    command->add_flag("--correct-processing", options->simulation.options.corrects_processing,
                      "take off what sampling and filters do to the torque of the simulation; not for cloe");
    command->add_option(
        "--period", options->simulation.period,
        "average the periods of the logs, each this many seconds, or auto (found; where nothing repeats, "
        "the whole logs are rows); wls and cwls then weight every sample by its torque covariance");
    command->add_flag("--stream", options->stream,
                      "read the logs in parts, so that memory does not depend on their length: ols and wls, with "
                      "--period cwls too; done by itself for logs above 256 MiB (compressed 64 MiB)");
    add_loop_options(*command, options->simulation.loop);
    add_consistency_options(*command, options->simulation.consistency);
    add_filter_options(*command, options->filter);
    command->add_option("--truth", options->truth, "parameters that were simulated, to compare with");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
