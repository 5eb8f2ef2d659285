#include "undeclared/case_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

namespace idim::undeclared {

namespace {

std::string truth_text(const bench_case& made) {
    std::string text;
    for (std::size_t i = 0; i < made.effects.size(); ++i) {
        const missing_effect& e = made.effects[i];
        text += fmt::format("{}{}@j{}", text.empty() ? "" : "+", e.form, e.joint + 1);
        text += e.other >= 0 ? fmt::format("/j{}", e.other + 1) : "";
        text += fmt::format(" rho {:.2f}", made.rho_made[i]);
    }
    return text.empty() ? "nothing" : text;
}

std::string found_text(const finding& found) {
    if (!found.ran()) {
        return found.timed_out ? "TIMEOUT" : fmt::format("FAILED ({}): {}", found.exit_status, found.message);
    }
    std::string text = found.verdict;
    for (const found_effect& step : found.steps) {
        text += fmt::format("; {}@{}", step.effect.name, fmt::join(step.effect.joints, "/"));
        text += step.effect.from.empty() ? "" : fmt::format("<{}", fmt::join(step.effect.from, "/"));
        text += fmt::format(" p {:.1e} explained {:.2f}", step.p_value, step.explained);
        for (const named_effect& other : step.confusable_with) {
            text += fmt::format(" ~{}@{}", other.name, fmt::join(other.joints, "/"));
        }
    }
    for (const found_structure& structure : found.unexplained) {
        text += fmt::format("; unexplained {} {}", structure.joint, fmt::join(structure.signals, "*"));
    }
    return text;
}

void drop_logs(bench_case& made) {
    made.identification.clear();
    made.validation.clear();
}

}  // namespace

case_result run_case(const tool& under_test, const std::string& class_name, std::uint64_t seed,
                     const std::string& folder) {
    case_result result;
    result.made.class_name = class_name;
    result.made.seed = seed;
    try {
        result.made = make_case(class_name, seed);
        write_case(result.made, folder);
        result.found = run_refine(under_test, result.made, folder);
        write_truth(result.made, folder);
        if (result.found.ran()) {
            result.true_model = true_model_errors(under_test, result.made, folder);
        }
        result.scored = score_of(result.made, result.found, result.true_model.value_or(model_errors{}));
    } catch (const std::exception& problem) {
        result.problem = problem.what();
    }
    drop_logs(result.made);
    return result;
}

std::string line_of(const case_result& result) {
    const bench_case& made = result.made;
    const std::string head = fmt::format(
        "{} {} | {} {:.0f} Hz{}{} {}/{} | {}", made.class_name, made.seed, made.robot.kind, made.settings.log_rate,
        made.settings.commanded ? " commanded" : "", made.settings.regularisation == 0.0 ? " sticking" : "",
        made.settings.position.kind, made.settings.torque.kind, truth_text(made));
    if (!result.problem.empty()) {
        return head + " | BENCH: " + result.problem;
    }
    std::string line = head + " | " + found_text(result.found);
    if (result.true_model) {
        line +=
            fmt::format(" | valid {:.3f} -> {:.3f} %, to true {:.3f} (worst joint {:.2f}), rho there {:.2f}",
                        100.0 * result.found.before_validation.relative, 100.0 * result.found.after_validation.relative,
                        result.scored.ratio, result.scored.worst_joint_ratio, result.scored.rho_in_tool_band);
    }
    for (const scored_effect& effect : result.scored.effects) {
        line += effect.exactly ? " | right" : (effect.named ? " | family" : " | MISSED");
        line += effect.compared;
    }
    line += result.scored.surplus > 0 ? fmt::format(" | SURPLUS {}", result.scored.surplus) : "";
    return line + fmt::format(" | {:.1f} s", result.found.seconds);
}

nlohmann::json json_of(const case_result& result) {
    const bench_case& made = result.made;
    nlohmann::json content = {{"class", made.class_name},
                              {"seed", made.seed},
                              {"robot", made.robot.kind},
                              {"line", line_of(result)},
                              {"seconds", result.found.seconds}};
    if (!result.problem.empty()) {
        content["problem"] = result.problem;
        return content;
    }
    content["truth"] = nlohmann::json::array();
    for (std::size_t i = 0; i < made.effects.size(); ++i) {
        const missing_effect& e = made.effects[i];
        const scored_effect& s = result.scored.effects[i];
        content["truth"].push_back({{"form", e.form},
                                    {"effect", e.name},
                                    {"joint", e.joint + 1},
                                    {"other", e.other + 1},
                                    {"rho", made.rho_made[i]},
                                    {"linear", e.linear},
                                    {"shape", e.shape},
                                    {"named", s.named},
                                    {"exactly", s.exactly},
                                    {"right_joint", s.right_joint}});
    }
    content["verdict"] = result.found.verdict;
    content["named_as"] = result.scored.named_as;
    content["steps"] = result.scored.steps;
    content["surplus"] = result.scored.surplus;
    content["worse"] = result.scored.worse;
    content["ratio_to_true_model"] = result.scored.ratio;
    content["rho_in_tool_band"] = result.scored.rho_in_tool_band;
    return content;
}

}  // namespace idim::undeclared
