#include "refine_report.hpp"

#include <fmt/format.h>

#include "trace_json.hpp"

namespace idim::cli {

namespace {

std::string error_table(const refine_outcome& outcome) {
    std::string text = "| joint | fitted, before | after | held back, before | after |\n|---|---|---|---|---|\n";
    const auto row = [&](const std::string& name, double a, double b, double c, double d) {
        text += fmt::format("| {} | {:.2f} % | {:.2f} % | {:.2f} % | {:.2f} % |\n", name, 100.0 * a, 100.0 * b,
                            100.0 * c, 100.0 * d);
    };
    const trace_errors& before = outcome.errors_before;
    const trace_errors& after = outcome.errors_after;
    row("all", before.identification.relative_error, after.identification.relative_error,
        before.validation.relative_error, after.validation.relative_error);
    for (std::size_t j = 0; j < before.identification.joints.size(); ++j) {
        row(joint_name(outcome.before.robot, static_cast<int>(j)), before.identification.joints[j].relative_error,
            after.identification.joints[j].relative_error, before.validation.joints[j].relative_error,
            after.validation.joints[j].relative_error);
    }
    return text;
}

std::string step_text(const trace_step& step, const loaded_robot& robot) {
    std::string text = fmt::format(
        "- **{}**: p {:.2g}, explains {:.0f} % of the residual variance beyond the noise on "
        "data held back; error there {:.2f} % -> {:.2f} %\n",
        describe(step.place, robot), step.p_value, 100.0 * step.explained_fraction, 100.0 * step.before.relative_error,
        100.0 * step.after.relative_error);
    text += step.torque.empty() ? "" : fmt::format("  - torque {}\n", step.torque);
    for (const effect_parameter& parameter : step.parameters) {
        text += "  - " + describe(parameter) + "\n";
    }
    for (const effect_place& other : step.confusable_with) {
        text += fmt::format("  - this data cannot tell it from {}\n", describe(other, robot));
    }
    return text;
}

std::string candidate_table(const refine_outcome& outcome) {
    constexpr std::size_t shown = 10;
    std::string text = "| candidate | p | explains | why it is not in the model |\n|---|---|---|---|\n";
    for (std::size_t i = 0; i < std::min(shown, outcome.trace.candidates.size()); ++i) {
        const trace_candidate& candidate = outcome.trace.candidates[i];
        text += fmt::format("| {} | {:.2g} | {:.1f} % | {} |\n", describe(candidate.place, outcome.before.robot),
                            candidate.p_value, 100.0 * candidate.explained_fraction, candidate.objection);
    }
    return text;
}

std::string unsupported_text(const refine_outcome& outcome) {
    std::string text;
    for (const unsupported_term& term : outcome.trace.unsupported) {
        text += "- " + describe(term, outcome.trace.after, outcome.before.robot) + "\n";
    }
    return text.empty() ? "" : "\n## Declared, not supported by this data\n\n" + text;
}

std::string hidden_text(const refine_outcome& outcome) {
    std::string text;
    for (const hidden_effect& hidden : outcome.trace.not_identifiable) {
        text += fmt::format("- {}: {}\n", describe(hidden.place, outcome.before.robot), hidden.reason);
    }
    return text.empty() ? "" : "\n## Not identifiable from this data (within the span of the model)\n\n" + text;
}

}  // namespace

std::string to_markdown(const refine_outcome& outcome) {
    const loaded_robot& robot = outcome.before.robot;
    std::string text = fmt::format("# {}: {}\n\n", robot.generated.robot, verdict_of(outcome.trace));
    text += outcome.before.filter.reason + ".\n";
    text += outcome.before.held_back_note.empty() ? "" : outcome.before.held_back_note + ".\n";
    text += "\n## Errors, |Y - W chi| / |Y|\n\n" + error_table(outcome);
    text += "\n## Effects added\n\n";
    for (const trace_step& step : outcome.trace.steps) {
        text += step_text(step, robot);
    }
    text += outcome.trace.steps.empty() ? "None.\n" : "";
    if (!outcome.trace.unexplained.empty()) {
        text += "\n## Structure that no known effect fits\n\n";
        for (const unexplained_structure& structure : outcome.trace.unexplained) {
            text += fmt::format("- {}: depends on {}, {:.0f} % of the residual variance\n",
                                joint_name(robot, structure.joint), fmt::join(structure.signals, ", "),
                                100.0 * structure.explained_fraction);
        }
    }
    text += fmt::format("\n## What was tried last\n\n{}\np corrected for {:.0f} candidates and shapes.\n",
                        candidate_table(outcome), outcome.trace.tests);
    text += unsupported_text(outcome) + hidden_text(outcome);
    return text;
}

}  // namespace idim::cli
