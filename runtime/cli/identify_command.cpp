#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identification.hpp"
#include "identified_parameters.hpp"
#include "idim/estimate.hpp"
#include "idim/input_error.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

namespace {

struct identify_options {
    std::string robot;
    std::vector<std::string> logs;
    std::string method = "wls";
    filter_request filter;
    std::string truth;
    std::string json_file;
};

const std::map<std::string, least_squares_method>& methods() {
    static const std::map<std::string, least_squares_method> names = {
        {"ols", least_squares_method::ols}, {"wls", least_squares_method::wls}, {"irls", least_squares_method::irls}};
    return names;
}

void print_parameters(const identification& found) {
    const Eigen::VectorXd std = found.result.deviations();
    fmt::print("  {:<10} {:>13} {:>11} {:>8}  {}\n", "parameter", "value", "std", "%", "unit");
    for (Eigen::Index k = 0; k < found.result.chi.size(); ++k) {
        const auto& parameter = found.robot.generated.base.parameters[static_cast<std::size_t>(k)];
        fmt::print("  {:<10} {:>13.6g} {:>11.3g} {:>8.2f}  {}\n", parameter.name, found.result.chi[k], std[k],
                   relative_percent(std[k], found.result.chi[k]), parameter.unit);
    }
}

void print_identification(const identification& found, const std::string& method) {
    const estimate& result = found.result;
    fmt::print("{}: {}, {} rows, condition number {:.3g} ({:.3g} with columns scaled)\n", found.robot.generated.robot,
               method, result.samples, result.condition_number, result.scaled_condition_number);
    fmt::print("  {}\n", found.filter.reason);
    print_parameters(found);
    print(result.residual, found.robot);
    fmt::print("  residual correlated over {:.1f} rows (by joint); the deviations account for it\n",
               fmt::join(result.correlation_length, " "));
    std::vector<std::string> dropped;
    for (const int k : found.essential.dropped) {
        dropped.push_back(found.robot.generated.base.parameters[static_cast<std::size_t>(k)].name);
    }
    fmt::print("  essential: {} of {} parameters, relative error {:.2f} %; without: {}\n", found.essential.kept.size(),
               result.chi.size(), 100.0 * found.essential.residual.relative_error,
               dropped.empty() ? "none" : fmt::format("{}", fmt::join(dropped, " ")));
}

/// For simulated logs: how far the estimate is from what was simulated, in its own deviations.
void print_truth(const identification& found, const Eigen::VectorXd& truth) {
    const Eigen::VectorXd std = found.result.deviations();
    fmt::print("  {:<10} {:>13} {:>13} {:>22}\n", "parameter", "truth", "estimate", "error in deviations");
    for (Eigen::Index k = 0; k < truth.size(); ++k) {
        fmt::print("  {:<10} {:>13.6g} {:>13.6g} {:>22.2f}\n",
                   found.robot.generated.base.parameters[static_cast<std::size_t>(k)].name, truth[k],
                   found.result.chi[k], (found.result.chi[k] - truth[k]) / std[k]);
    }
}

/// One line that says what the data lacks.
std::string explain(const identification& found, const std::vector<std::string>& at_rest) {
    std::vector<std::string> names;
    for (const int k : found.result.not_excited) {
        names.push_back(found.robot.generated.base.parameters[static_cast<std::size_t>(k)].name);
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

int run(const identify_options& options) {
    const loaded_robot robot = load_robot(options.robot);
    const Eigen::VectorXd truth = options.truth.empty() ? Eigen::VectorXd() : read_parameters(options.truth, robot).chi;
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const std::vector<std::string> at_rest = joints_at_rest(robot, logs);
    if (at_rest.size() == robot.generated.joints.size()) {
        throw data_error(explain_standstill(robot, at_rest));
    }
    const filter_choice filter = choose_filter(logs, options.filter);
    const identification found =
        identify(robot, filter, observe_logs(robot, logs, filter), methods().at(options.method));
    write_json(options.json_file, to_json(found, options.method));
    if (found.result.chi.size() == 0) {
        throw data_error(found.result.not_excited.empty() ? found.result.message : explain(found, at_rest));
    }
    if (prints_text(options.json_file)) {
        print_identification(found, options.method);
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
    command->add_option("--method", options->method, "ols, wls (default) or irls")
        ->check(CLI::IsMember({"ols", "wls", "irls"}));
    add_filter_options(*command, options->filter);
    command->add_option("--truth", options->truth, "parameters that were simulated, to compare with");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
