#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identified_parameters.hpp"
#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "measured_motion.hpp"
#include "method_report.hpp"
#include "method_run.hpp"

namespace idim::cli {

namespace {

struct identify_options {
    std::string robot;
    std::vector<std::string> logs;
    std::string method = "wls";
    bool compare = false;
    method_request simulation;
    filter_request filter;
    std::string truth;
    std::string json_file;
};

/// What the command knows at the end.
struct identification {
    loaded_robot robot;
    filter_choice filter;
    observation rows;
    method_result by;
    estimate result;
    essential_parameters essential;
};

double relative_percent(double std, double value) {
    return 100.0 * std / std::abs(value);
}

json parameters_json(const identification& found) {
    json list = json::array();
    const Eigen::VectorXd std = found.result.deviations();
    for (Eigen::Index k = 0; k < found.result.chi.size(); ++k) {
        const auto& parameter = parameter_of(found.robot, found.rows, k);
        list.push_back({{"name", parameter.name},
                        {"value", found.result.chi[k]},
                        {"std", std[k]},
                        {"relative_std_percent", finite(relative_percent(std[k], found.result.chi[k]))},
                        {"unit", parameter.unit},
                        {"regroups", parameter.regroups}});
        if (const int log = column_of(found.rows, static_cast<int>(k)).log; log >= 0) {
            list.back()["log"] = found.rows.blocks[static_cast<std::size_t>(log)].file;
        }
    }
    return list;
}

json essential_json(const identification& found) {
    json kept = json::array();
    for (const int k : found.essential.kept) {
        kept.push_back({{"name", name_of(found.robot, found.rows, k)},
                        {"value", found.essential.chi[k]},
                        {"std", found.essential.std[k]}});
    }
    return {{"parameters", kept},
            {"f_statistic", finite(found.essential.f_statistic)},
            {"p_value", finite(found.essential.p_value)},
            {"residual", to_json(found.essential.residual, found.robot)}};
}

json names_json(const identification& found, const std::vector<int>& columns) {
    json names = json::array();
    for (const int k : columns) {
        names.push_back(name_of(found.robot, found.rows, k));
    }
    return names;
}

json identification_json(const identification& found) {
    json rates = json::array();
    json files = json::array();
    for (const observation_block& block : found.rows.blocks) {
        rates.push_back(block.rate);
        files.push_back(block.file);
    }
    const double full_rate = found.rows.blocks.front().rate * found.filter.decimation;
    return {{"robot", found.robot.generated.robot},
            {"input_hash", found.robot.generated.input_hash},
            {"method", found.by.method},
            {"converged", found.result.converged},
            {"message", found.result.message},
            {"logs", files},
            {"filter", to_json(found.filter)},
            {"band", found.filter.band(full_rate)},
            {"row_rates", rates},
            {"iterations", iterations_json(found.result, found.robot)},
            {"loop", loop_json(found.by)},
            {"tests", tests_json(found.by, found.robot)},
            {"samples", found.result.samples},
            {"rank", found.result.rank},
            {"condition_number", finite(found.result.condition_number)},
            {"scaled_condition_number", finite(found.result.scaled_condition_number)},
            {"correlation_length", found.result.correlation_length},
            {"not_excited", names_json(found, found.result.not_excited)},
            {"parameters", parameters_json(found)},
            {"essential", found.essential.kept.empty() ? json(nullptr) : essential_json(found)},
            {"residual", found.result.chi.size() > 0 ? to_json(found.result.residual, found.robot) : json(nullptr)}};
}

void print_parameters(const identification& found) {
    const Eigen::VectorXd std = found.result.deviations();
    fmt::print("  {:<10} {:>13} {:>11} {:>8}  {}\n", "parameter", "value", "std", "%", "unit");
    for (Eigen::Index k = 0; k < found.result.chi.size(); ++k) {
        const auto& parameter = parameter_of(found.robot, found.rows, k);
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

void print_identification(const identification& found) {
    const estimate& result = found.result;
    fmt::print("{}: {}, {} rows, condition number {:.3g} ({:.3g} with columns scaled)\n", found.robot.generated.robot,
               found.by.method, result.samples, result.condition_number, result.scaled_condition_number);
    fmt::print("  {}\n", found.filter.reason);
    print_iterations(found.by, found.robot);
    print_parameters(found);
    print(result.residual, found.robot);
    fmt::print("  residual correlated over {:.1f} rows (by joint); the deviations account for it\n",
               fmt::join(result.correlation_length, " "));
    print_tests(found.by, found.robot);
    if (!found.essential.kept.empty()) {
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

int run(const identify_options& options) {
    loaded_robot robot = load_robot(options.robot);
    const Eigen::VectorXd truth = options.truth.empty() ? Eigen::VectorXd() : read_parameters(options.truth, robot).chi;
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const std::vector<std::string> at_rest = joints_at_rest(robot, logs);
    if (at_rest.size() == robot.generated.joints.size()) {
        throw data_error(explain_standstill(robot, at_rest));
    }
    const filter_choice filter = choose_filter(logs, options.filter);
    method_runner runner(robot, options.robot, logs, filter, options.simulation);
    if (options.compare) {
        return compare(options, robot, filter, runner);
    }
    observation rows = simulates(options.method) ? runner.steady_rows() : runner.all_rows();
    method_result by = runner.run(options.method, rows);
    estimate result = by.fit;
    essential_parameters essential;
    // The F test behind it supposes least squares on these rows.
    if (result.chi.size() > 0 && !simulates(options.method)) {
        essential = find_essential(rows, result);
    }
    const identification found{std::move(robot),    filter, std::move(rows), std::move(by), std::move(result),
                               std::move(essential)};
    write_json(options.json_file, identification_json(found));
    if (found.result.chi.size() == 0) {
        if (prints_text(options.json_file)) {
            print_iterations(found.by, found.robot);
        }
        const bool unexcited = !found.result.not_excited.empty() && found.result.iterations.empty();
        throw data_error(unexcited ? explain(found, at_rest) : found.result.message);
    }
    if (prints_text(options.json_file)) {
        print_identification(found);
        if (truth.size() > 0) {
            print_truth(found, truth);
        }
    }
    return exit_done;
}

}  // namespace

void add_identify_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<identify_options>();
    CLI::App* command = app.add_subcommand("identify", "base parameters from measured motion, with deviations");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("logs", options->logs, "logs (.csv, .csv.gz)")->required();
    command
        ->add_option(
            "--method", options->method,
            "least squares: ols, wls (default), irls (robust), tls (total); with the closed loop simulated: iv "
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
    add_loop_options(*command, options->simulation.loop);
    add_filter_options(*command, options->filter);
    command->add_option("--truth", options->truth, "parameters that were simulated, to compare with");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
