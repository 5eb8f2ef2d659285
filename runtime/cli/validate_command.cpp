#include <fmt/format.h>

#include "identified_parameters.hpp"
#include "idim/input_error.hpp"
#include "idim/log_parameters.hpp"
#include "measured_motion.hpp"
#include "simulated_loop.hpp"
#include "torque_bands.hpp"

namespace idim::cli {

namespace {

struct validate_options {
    std::string robot;
    std::string result;
    std::vector<std::string> logs;
    filter_request filter;
    bool simulate = false;
    loop_request loop;
    std::string series_file;
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

/// A posteriori simulation of the direct model along the references of the logs. The gains of the simulated law are
/// those of a robot with these parameters.
struct simulated_validation {
    loop_validation result;
    std::string assumption;
};

simulated_validation simulate_logs(const validate_options& options, const loaded_robot& robot,
                                   const std::vector<idim::log>& logs, const filter_choice& filter,
                                   const Eigen::VectorXd& chi) {
    const closed_loop loop = simulated_loops_of(robot, options.robot, logs, filter, options.loop, chi).fixed;
    const loop_experiment experiment{robot.model(), logs, filter};
    return {validate_in_loop(experiment, loop, observe_steady(experiment, loop), chi), loop.assumption};
}

json simulation_json(const simulated_validation& simulated, const loaded_robot& robot) {
    const loop_validation& result = simulated.result;
    json joints = json::array();
    for (std::size_t j = 0; j < result.judged.to_measured.size(); ++j) {
        const motion_distance& distance = result.judged.to_measured[j];
        joints.push_back({{"joint", robot.generated.joints[j].name},
                          {"q", finite(distance.q)},
                          {"qd", finite(distance.qd)},
                          {"qdd", finite(distance.qdd)}});
    }
    return {{"assumption", simulated.assumption.empty() ? json(nullptr) : json(simulated.assumption)},
            {"torque", to_json(result.simulated, robot)},
            {"distance_to_measured", joints}};
}

void print_simulation(const simulated_validation& simulated, const loaded_robot& robot) {
    const loop_validation& result = simulated.result;
    fmt::print("  simulated along the references{}{}\n", simulated.assumption.empty() ? "" : "; ",
               simulated.assumption);
    for (std::size_t j = 0; j < result.judged.to_measured.size(); ++j) {
        const motion_distance& distance = result.judged.to_measured[j];
        fmt::print("    {}: {:.3g} % from the measured position, {:.3g} % velocity, {:.3g} % acceleration\n",
                   robot.generated.joints[j].name, 100.0 * distance.q, 100.0 * distance.qd, 100.0 * distance.qdd);
    }
    fmt::print("    torque along the simulated motion:");
    print(result.simulated, robot);
}

/// Bands for rows filtered as those were that the parameters were identified from; others have other errors.
std::optional<torque_bands> bands_for(const observation& rows, const Eigen::VectorXd& chi,
                                      const identified_parameters& parameters, const filter_choice& filter) {
    const bool same = parameters.filter && parameters.filter->cutoff == filter.cutoff &&
                      parameters.filter->order == filter.order && parameters.filter->decimation == filter.decimation;
    return same && parameters.spread && chi.size() == parameters.chi.size()
               ? std::optional(bands_of(rows, chi, *parameters.spread))
               : std::nullopt;
}

/// Errors of `rows`, with the bands, in both forms.
json report_rows(const observation& rows, const Eigen::VectorXd& chi, const identified_parameters& parameters,
                 const std::optional<torque_bands>& bands, const loaded_robot& robot, bool prints) {
    const error_summary total = errors(rows, chi);
    json content = to_json(total, robot);
    if (bands) {
        add_bands(content["joints"], *bands, *parameters.spread);
    }
    if (prints) {
        print(total, robot);
        if (bands) {
            print(*bands, robot);
        }
    }
    return content;
}

int run(const validate_options& options) {
    const loaded_robot robot = load_robot(options.robot);
    const identified_parameters parameters = read_parameters(options.result, robot);
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const filter_choice filter = filter_for(options, parameters, logs);
    const observation all = with_log_columns(robot.model(), observe_logs(robot, logs, filter, parameters.chi));
    const Eigen::VectorXd chi = with_log_parameters(robot.model(), all, parameters.chi);
    std::optional<simulated_validation> simulated;
    if (options.simulate) {
        simulated = simulate_logs(options, robot, logs, filter, parameters.chi);
        if (!simulated->result.failure.empty()) {
            throw data_error(simulated->result.failure);
        }
    }
    const bool prints = prints_text(options.json_file);
    if (prints) {
        fmt::print("{}: {} validated on {} rows\n  {}\n", robot.generated.robot, options.result, all.rows(),
                   filter.reason);
    }
    const std::optional<torque_bands> bands = bands_for(all, chi, parameters, filter);
    json content = report_rows(all, chi, parameters, bands, robot, prints);
    content["robot"] = robot.generated.robot;
    content["filter"] = to_json(filter);
    content["logs"] = json::array();
    for (const observation_block& block : all.blocks) {
        const observation one{{block}, all.dof, all.n_base};
        const bool prints_one = prints && all.blocks.size() > 1;
        if (prints_one) {
            fmt::print("  {}:", block.file);
        }
        json entry = {{"log", block.file}};
        entry.update(report_rows(one, chi, parameters, bands_for(one, chi, parameters, filter), robot, prints_one));
        content["logs"].push_back(entry);
    }
    if (simulated) {
        content["simulation"] = simulation_json(*simulated, robot);
        if (prints_text(options.json_file)) {
            print_simulation(*simulated, robot);
        }
    }
    if (!options.series_file.empty()) {
        write_text(options.series_file, series_text(all, chi, robot, bands));
    }
    write_json(options.json_file, content);
    return exit_done;
}

}  // namespace

void add_validate_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<validate_options>();
    CLI::App* command =
        app.add_subcommand("validate", "errors of an identified model on other data, with confidence bands");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("result", options->result, "result of identify --json, or a map of parameter names to values")
        ->required();
    command->add_option("logs", options->logs, "logs (.csv, .csv.gz)")->required();
    add_filter_options(*command, options->filter);
    command->add_flag("--simulate", options->simulate,
                      "simulate the closed loop along the references and compare the motion");
    add_loop_options(*command, options->loop);
    command->add_option(
        "--series", options->series_file,
        "writes torque, prediction and 95 % band of every row (CSV: log,joint,t,tau,predicted,low,high)");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
