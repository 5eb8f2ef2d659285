#include <fmt/format.h>

#include "trace_json.hpp"
#include "traced_robot.hpp"

namespace idim::cli {

namespace {

constexpr std::size_t candidates_shown = 12;

/// A diagnosis names what would be added: candidates that pass make the residual one with a missing effect.
std::string diagnosis_of(const effect_trace& trace) {
    const bool explains = !trace.candidates.empty() && trace.candidates.front().objection.empty();
    return explains || !trace.unexplained.empty() ? "unexplained_residual" : "no_missing_effect";
}

void print_diagnosis(const traced_robot& traced, const effect_trace& trace) {
    fmt::print("{}: {}\n  {}\n", traced.robot.generated.robot, diagnosis_of(trace), traced.filter.reason);
    if (!traced.held_back_note.empty()) {
        fmt::print("  {}\n", traced.held_back_note);
    }
    fmt::print("fitted:\n");
    print(trace.before.identification, traced.robot);
    fmt::print("held back:\n");
    print(trace.before.validation, traced.robot);
    fmt::print("{:<56} {:>10} {:>9}  {}\n", "candidate", "p", "explains", "why it is not accepted");
    for (std::size_t i = 0; i < std::min(candidates_shown, trace.candidates.size()); ++i) {
        const trace_candidate& candidate = trace.candidates[i];
        fmt::print("{:<56} {:>10.2g} {:>7.1f} %  {}\n", describe(candidate.place, traced.robot), candidate.p_value,
                   100.0 * candidate.explained_fraction, candidate.objection);
    }
    fmt::print("p corrected for {:.0f} candidates and shapes tried\n", trace.tests);
    for (const hidden_effect& hidden : trace.not_identifiable) {
        fmt::print("not identifiable from this data: {}, {}\n", describe(hidden.place, traced.robot), hidden.reason);
    }
    for (const unsupported_term& term : trace.unsupported) {
        fmt::print("declared, not supported by this data: {}\n", describe(term, trace.after, traced.robot));
    }
}

int run(const trace_options& options) {
    const traced_robot traced = load_traced_robot(options);
    trace_input input = traced.input();
    input.most_effects = 0;
    const effect_trace trace = trace_effects(input);
    json content = {{"robot", traced.robot.generated.robot},
                    {"verdict", diagnosis_of(trace)},
                    {"before", to_json(trace.before, traced.robot)}};
    content.update(to_json(trace, traced));
    write_json(options.json_file, content);
    if (prints_text(options.json_file)) {
        print_diagnosis(traced, trace);
    }
    return exit_done;
}

}  // namespace

void add_diagnose_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<trace_options>();
    CLI::App* command =
        app.add_subcommand("diagnose", "the residual of an identified model and the effects that would explain it");
    add_trace_options(*command, *options);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
