#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "earlier_steps.hpp"
#include "emit/model_folder.hpp"
#include "idim/input_error.hpp"
#include "idim/log_parameters.hpp"
#include "idim/unified_diff.hpp"
#include "interrupt_watch.hpp"
#include "proposed_effects.hpp"
#include "refine_report.hpp"
#include "refined_description.hpp"
#include "trace_json.hpp"
#include "traced_robot.hpp"

namespace idim::cli {

namespace {

namespace fs = std::filesystem;

struct refine_options : trace_options {
    std::string folder;
    int most_effects = 12;
    bool resume = false;
};

least_squares_method method_of(const std::string& name) {
    return name == "ols"    ? least_squares_method::ols
           : name == "irls" ? least_squares_method::irls
                            : least_squares_method::wls;
}

/// Identified on the logs to fit; errors on these and on those held back.
struct identified_robot {
    identification found;
    trace_errors errors;
};

/// Errors of base parameters on logs they were not fitted to; what is each log's own is fitted there.
error_summary errors_on(const traced_robot& traced, const std::vector<filtered_samples>& logs,
                        const Eigen::VectorXd& chi) {
    const idim_model_interface& model = traced.robot.model();
    const Eigen::VectorXd base = chi.head(model.n_base);
    const observation rows = with_log_columns(model, observe(model, logs, traced.filter, base));
    return errors(rows, with_log_parameters(model, rows, base));
}

identified_robot identify_traced(const traced_robot& traced, const std::string& method) {
    identification found = identify(traced.robot, traced.filter, traced.fitted, method_of(method));
    if (found.result.chi.size() == 0) {
        throw data_error(found.result.message);
    }
    trace_errors all{found.result.residual, errors_on(traced, traced.held_back, found.result.chi)};
    return {std::move(found), std::move(all)};
}

void say(const std::string& line) {
    fmt::print(stderr, "  {}\n", line);
}

json result_json(const identified_robot& identified, const traced_robot& traced, const std::string& method) {
    json content = to_json(identified.found, method);
    content["validation"] = to_json(identified.errors.validation, traced.robot);
    return content;
}

/// What a reviewer reads: the change of the generated code.
std::string model_difference(const loaded_robot& before, const loaded_robot& after) {
    std::vector<file_change> changes;
    for (const generator::rendered_file& wanted : after.generated.files) {
        file_change change{wanted.name, std::nullopt, wanted.text};
        for (const generator::rendered_file& present : before.generated.files) {
            if (present.name == wanted.name) {
                change.before = present.text;
            }
        }
        if (change.before != change.after) {
            changes.push_back(std::move(change));
        }
    }
    return unified_diff(changes);
}

/// The description with the effects found, its model generated, built and identified.
struct rebuilt_robot {
    explicit rebuilt_robot(traced_robot robot, const std::string& method)
        : traced(std::move(robot)), identified(identify_traced(traced, method)) {}

    traced_robot traced;
    identified_robot identified;
};

std::string description_in(const refine_options& options) {
    return (fs::path(options.folder) / "robot.yaml").string();
}

std::unique_ptr<const rebuilt_robot> rebuild(const refine_options& options, const traced_robot& before,
                                             const std::vector<trace_step>& steps) {
    const std::string file = write_refined_description(options.robot, before, steps, options.folder);
    return std::make_unique<const rebuilt_robot>(with_description(before, file), options.method);
}

/// Whether joints are worse off on the whole, each beside what it was, or their torques together by more than one per
/// cent: what a light joint gains moves the parameters of heavy ones within their deviations.
bool worse(const error_summary& after, const error_summary& before) {
    constexpr double margin = 2e-3;
    constexpr double together = 1e-2;
    return error_ratio(before, after) > 1.0 + margin || after.relative_error > before.relative_error * (1.0 + together);
}

/// Nothing where the robot with these steps cannot be identified, which is said.
std::unique_ptr<const rebuilt_robot> rebuild_if_identifiable(const refine_options& options, const traced_robot& before,
                                                             const std::vector<trace_step>& steps) {
    try {
        return rebuild(options, before, steps);
    } catch (const data_error& problem) {
        if (steps.empty()) {
            throw;
        }
        say(problem.what());
        return nullptr;
    }
}

/// Takes steps back from the end while the data held back is worse off with them, or the model cannot be identified.
std::unique_ptr<const rebuilt_robot> rebuild_what_helps(const refine_options& options, const traced_robot& before,
                                                        const error_summary& errors_before,
                                                        std::vector<trace_step>& steps) {
    std::unique_ptr<const rebuilt_robot> last = rebuild_if_identifiable(options, before, steps);
    while (!steps.empty() && (!last || worse(last->identified.errors.validation, errors_before))) {
        say(fmt::format("{} is taken back: {}", steps.back().place.effect,
                        last ? "the model identified with it is worse on data held back"
                             : "the model cannot be identified with it"));
        steps.pop_back();
        last = rebuild_if_identifiable(options, before, steps);
    }
    return last;
}

/// Tries what idim itself proposes for structure that no known effect fits, on the same terms as all else.
void add_proposals(const traced_robot& found, const std::vector<proposed_effect>& proposals, int most_effects,
                   effect_trace& trace) {
    trace_input input = found.input();
    input.most_effects = most_effects;
    input.progress = say;
    for (const proposed_effect& proposal : proposals) {
        input.only.push_back(proposal.place);
    }
    effect_trace more = trace_effects(input);
    for (const proposed_effect& proposal : proposals) {
        say(fmt::format("proposed at joint {}: {}", proposal.place.joints.front() + 1, proposal.torque));
        for (const trace_candidate& candidate : more.candidates) {
            if (candidate.place == proposal.place && !candidate.objection.empty()) {
                say("  not accepted: " + candidate.objection);
            }
        }
    }
    trace.steps.insert(trace.steps.end(), more.steps.begin(), more.steps.end());
}

/// Says which structure has its effect now; files of proposals that are not in the model are removed.
void settle_proposals(const std::vector<proposed_effect>& proposals, effect_trace& trace) {
    for (const proposed_effect& proposal : proposals) {
        const auto step = std::find_if(trace.steps.begin(), trace.steps.end(),
                                       [&](const trace_step& s) { return s.place == proposal.place; });
        if (step == trace.steps.end()) {
            fs::remove(proposal.file);
        } else {
            step->torque = proposal.torque;
            trace.unexplained[proposal.structure].proposed = proposal.place.effect;
        }
    }
}

json refine_json(const refine_outcome& outcome, const refine_options& options) {
    json content = {{"robot", outcome.before.robot.generated.robot},
                    {"verdict", verdict_of(outcome.trace)},
                    {"method", options.method},
                    {"before", to_json(outcome.errors_before, outcome.before.robot)},
                    {"after", to_json(outcome.errors_after, outcome.before.robot)}};
    if (outcome.trace.interrupted) {
        content["interrupted"] = true;
    }
    content.update(to_json(outcome.trace, outcome.before));
    return content;
}

void print_outcome(const refine_outcome& outcome, const refine_options& options) {
    fmt::print("{}: {}\n", outcome.before.robot.generated.robot, verdict_of(outcome.trace));
    for (const trace_step& step : outcome.trace.steps) {
        fmt::print("  {}: p {:.2g}, explains {:.0f} %\n", describe(step.place, outcome.before.robot), step.p_value,
                   100.0 * step.explained_fraction);
        if (!step.torque.empty()) {
            fmt::print("    torque {}\n", step.torque);
        }
        for (const effect_parameter& parameter : step.parameters) {
            fmt::print("    {}\n", describe(parameter));
        }
        for (const effect_place& other : step.confusable_with) {
            fmt::print("    this data cannot tell it from {}\n", describe(other, outcome.before.robot));
        }
    }
    for (const unexplained_structure& structure : outcome.trace.unexplained) {
        fmt::print("  no known effect fits: {} depends on {}, {:.0f} % of its residual variance\n",
                   joint_name(outcome.before.robot, structure.joint), fmt::join(structure.signals, " and "),
                   100.0 * structure.explained_fraction);
    }
    fmt::print("fitted, before and after:\n");
    print(outcome.errors_before.identification, outcome.before.robot);
    print(outcome.errors_after.identification, outcome.before.robot);
    fmt::print("held back, before and after:\n");
    print(outcome.errors_before.validation, outcome.before.robot);
    print(outcome.errors_after.validation, outcome.before.robot);
    if (outcome.trace.interrupted) {
        fmt::print("interrupted: more may be missing; the same command with --resume goes on from here\n");
    }
    fmt::print("in {}: robot.yaml, model/, model.diff, before.json, after.json, refine.json, report.md\n",
               options.folder);
}

int run(const refine_options& options) {
    const traced_robot before = load_traced_robot(options);
    const identified_robot first = identify_traced(before, options.method);
    trace_input input = before.input();
    input.most_effects = options.most_effects;
    input.progress = say;
    if (options.resume) {
        input.found = read_steps((fs::path(options.folder) / "refine.json").string(), before);
    }
    const interrupt_watch watch;
    input.go_on = [] { return !interrupt_watch::interrupted(); };
    effect_trace trace = trace_effects(input);
    if (trace.interrupted && trace.steps.empty()) {
        throw data_error("interrupted before anything was found: nothing is written");
    }
    fs::create_directories(options.folder);
    std::unique_ptr<const rebuilt_robot> last =
        rebuild_what_helps(options, before, first.errors.validation, trace.steps);
    const int more_effects = options.most_effects - static_cast<int>(trace.steps.size());
    const std::vector<proposed_effect> proposals =
        more_effects > 0 ? write_proposed_effects(trace, before, options.robot, options.folder)
                         : std::vector<proposed_effect>{};
    if (!proposals.empty()) {
        add_proposals(with_description(before, description_in(options)), proposals, more_effects, trace);
        last = rebuild_what_helps(options, before, last->identified.errors.validation, trace.steps);
        settle_proposals(proposals, trace);
    }
    const refine_outcome outcome{before, last->traced, first.errors, last->identified.errors, std::move(trace)};
    const fs::path folder = options.folder;
    generator::write_model(last->traced.robot.generated.files, (folder / "model").string());
    write_text(folder / "model.diff", model_difference(before.robot, last->traced.robot));
    write_json((folder / "before.json").string(), result_json(first, before, options.method));
    write_json((folder / "after.json").string(), result_json(last->identified, last->traced, options.method));
    write_text(folder / "report.md", to_markdown(outcome));
    const json content = refine_json(outcome, options);
    write_json((folder / "refine.json").string(), content);
    write_json(options.json_file, content);
    if (prints_text(options.json_file)) {
        print_outcome(outcome, options);
    }
    return exit_done;
}

}  // namespace

void add_refine_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<refine_options>();
    CLI::App* command = app.add_subcommand(
        "refine", "finds what the model lacks, adds it to the description, regenerates, rebuilds, identifies again");
    add_trace_options(*command, *options);
    command->add_option("-o,--output", options->folder, "folder for the new description, code, results and report")
        ->required();
    command->add_option("--method", options->method, "how the errors before and after are identified: ols, wls or irls")
        ->check(CLI::IsMember({"ols", "wls", "irls"}));
    command->add_option("--most", options->most_effects, "effects added at the most")->check(CLI::Range(0, 100));
    command->add_flag("--resume", options->resume,
                      "go on from the effects in the output folder's refine.json, found in the same logs");
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
