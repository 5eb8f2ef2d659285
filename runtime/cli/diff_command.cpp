#include <fmt/format.h>

#include <numbers>

#include "command.hpp"
#include "diff_json.hpp"
#include "diff_report.hpp"

namespace idim::cli {

namespace {

struct diff_options {
    std::string before;
    std::string after;
    bool markdown = false;
    bool exit_code = false;
    std::string json_file;
};

/// Within the limits of the new model, else of the old one, else a turn and what an industrial robot's joint does.
joint_range range_of(const generator::manifest_joint& joint, const generator::manifest_joint& old) {
    constexpr double usual_speed = 3.0;
    constexpr double usual_acceleration = 10.0;
    const double reach = joint.type == "prismatic" ? 1.0 : std::numbers::pi;
    const auto position = joint.position ? joint.position : old.position;
    const auto speed = joint.velocity ? joint.velocity : old.velocity;
    const auto [lowest, highest] = position.value_or(std::pair(-reach, reach));
    return {lowest, highest, speed.value_or(usual_speed), usual_acceleration};
}

/// Ranges of the driven joints, which both have in this order.
std::vector<joint_range> ranges_of(const generator::manifest& before, const generator::manifest& after) {
    std::vector<joint_range> result;
    for (const generator::manifest_joint& joint : after.joints) {
        for (const generator::manifest_joint& old : before.joints) {
            if (joint.driven && joint.name == old.name) {
                result.push_back(range_of(joint, old));
            }
        }
    }
    return result;
}

model_comparison compare(const compared_model& before, const compared_model& after) {
    model_comparison result{before, after, generator::compare(before.summary, after.summary), std::nullopt};
    if (!result.difference.not_comparable) {
        result.torques = compare_torques(before.compiled.interface(), after.compiled.interface(),
                                         ranges_of(before.summary.content, after.summary.content));
    }
    return result;
}

int run(const diff_options& options) {
    const compared_model before = load_compared(options.before);
    const compared_model after = load_compared(options.after);
    const model_comparison comparison = compare(before, after);
    write_json(options.json_file, to_json(comparison));
    if (prints_text(options.json_file)) {
        const diff_report found = report(comparison);
        fmt::print("{}", options.markdown ? to_markdown(found) : to_text(found));
    }
    return options.exit_code && !comparison.same() ? exit_check_said_no : exit_done;
}

}  // namespace

void add_diff_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<diff_options>();
    CLI::App* command = app.add_subcommand(
        "diff", "what changed between two models: parameters, effects, operations, and whether they compute the same");
    command
        ->add_option("old", options->before,
                     "robot description, or a folder that idim generate wrote (its code is compiled and run)")
        ->required();
    command->add_option("new", options->after, "likewise")->required();
    command->add_flag("--markdown", options->markdown, "as Markdown, for a pull request");
    command->add_flag("--exit-code", options->exit_code, "exit 1 where the models differ");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
