#include "diff_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace idim::cli {

namespace {

using generator::entry_change;
using generator::operation_count;
using generator::parameter_context;
using table_rows = std::vector<std::vector<std::string>>;

std::string origin(const compared_model& model) {
    const generator::manifest& content = model.summary.content;
    return fmt::format("{} ({}, input {})", model.path, content.generator, content.input_hash);
}

std::string torque_finding(const model_comparison& comparison) {
    if (!comparison.torques) {
        return "cannot be compared: " + *comparison.difference.not_comparable;
    }
    const torque_comparison& torques = *comparison.torques;
    const torque_difference& absolute = torques.absolute;
    const torque_difference& relative = torques.relative;
    switch (torques.verdict) {
        case torque_verdict::same:
            return fmt::format("the same to the last bit at {} random states", torques.states);
        case torque_verdict::same_up_to_rounding:
            return fmt::format(
                "the same up to rounding at {} random states; the largest difference is {:.1e} of the largest torque "
                "of {}",
                torques.states, relative.value, comparison.joint_name(relative.joint));
        case torque_verdict::different:
            break;
    }
    return fmt::format(
        "different, at {} random states with standard parameters from [-1, 1] by up to {:.3g} {} at {} and {:.3g} % of "
        "the largest torque of {}",
        torques.states, absolute.value, comparison.unit(absolute.joint), comparison.joint_name(absolute.joint),
        100.0 * relative.value, comparison.joint_name(relative.joint));
}

std::string one_side_finding(const torque_comparison& torques) {
    std::vector<std::string> parts;
    const auto add = [&parts](const std::vector<one_sided_parameter>& parameters, const char* side) {
        std::vector<std::string> names;
        for (const one_sided_parameter& parameter : parameters) {
            names.push_back(parameter.name);
        }
        if (!names.empty()) {
            parts.push_back(fmt::format("{} ({})", fmt::join(names, ", "), side));
        }
    };
    add(torques.only_before, "old only");
    add(torques.only_after, "new only");
    return fmt::format("{}", fmt::join(parts, "; "));
}

bool formula_changed(const generator::regrouping_change& change) {
    return change.before.regroups != change.after.regroups || change.before.unit != change.after.unit;
}

std::string base_finding(const model_comparison& comparison) {
    const generator::model_difference& difference = comparison.difference;
    const std::size_t before = comparison.before.summary.base.size();
    const std::size_t after = comparison.after.summary.base.size();
    const auto& regrouped = difference.regrouped;
    const auto formulas = std::count_if(regrouped.begin(), regrouped.end(), formula_changed);
    if (difference.base_added.empty() && difference.base_dropped.empty() && regrouped.empty()) {
        return fmt::format("{}, as before", after);
    }
    return fmt::format("{} -> {}: {} added, {} dropped, {} by another formula, {} with other coefficients only", before,
                       after, difference.base_added.size(), difference.base_dropped.size(), formulas,
                       regrouped.size() - static_cast<std::size_t>(formulas));
}

std::string column_finding(const generator::model_difference& difference) {
    const bool unchanged =
        difference.columns.empty() && difference.base_added.empty() && difference.base_dropped.empty();
    return unchanged                    ? "as before"
           : difference.columns.empty() ? "those that stay keep their place"
                                        : "moved, see below";
}

bool same_counts(const operation_count& a, const operation_count& b) {
    return a.mul == b.mul && a.add == b.add && a.div == b.div && a.functions == b.functions;
}

bool operations_changed(const generator::model_difference& difference) {
    return std::any_of(difference.operations.begin(), difference.operations.end(),
                       [](const generator::operations_change& change) {
                           return !change.in_both || !same_counts(change.before, change.after);
                       });
}

table_rows rows_of(const std::vector<parameter_context>& parameters) {
    table_rows result;
    for (const parameter_context& parameter : parameters) {
        result.push_back({parameter.name, parameter.unit, parameter.regroups});
    }
    return result;
}

table_rows effect_rows(const std::vector<generator::manifest_effect>& effects) {
    table_rows result;
    for (const generator::manifest_effect& effect : effects) {
        std::vector<std::string> places = effect.joints;
        for (std::size_t i = 0; i < effect.from.size(); ++i) {
            places[i] += " from " + effect.from[i];
        }
        std::string torque = effect.torque;
        for (const auto& [name, value] : effect.shape) {
            torque += fmt::format(", {} = {}", name, value);
        }
        result.push_back({effect.effect, fmt::format("{}", fmt::join(places, ", ")), torque});
    }
    return result;
}

std::string shown(const std::string& entry) {
    return entry.empty() ? "-" : entry;
}

table_rows rows_of(const std::vector<entry_change>& changes, bool with_field) {
    table_rows result;
    for (const entry_change& change : changes) {
        std::vector<std::string> row = {change.what};
        if (with_field) {
            row.push_back(shown(change.field));
        }
        row.push_back(shown(change.before));
        row.push_back(shown(change.after));
        result.push_back(row);
    }
    return result;
}

table_rows regrouping_rows(const std::vector<generator::regrouping_change>& changes) {
    table_rows result;
    for (const generator::regrouping_change& change : changes) {
        if (formula_changed(change)) {
            const auto text = [](const parameter_context& p) {
                return fmt::format("{} = {} [{}]", p.name, p.regroups, p.unit);
            };
            result.push_back({change.after.name, text(change.before), text(change.after)});
        }
    }
    return result;
}

table_rows coefficient_rows(const std::vector<generator::regrouping_change>& changes) {
    table_rows result;
    for (const generator::regrouping_change& change : changes) {
        for (const generator::coefficient_change& coefficient : change.coefficients) {
            result.push_back({change.after.name, coefficient.standard, fmt::format("{:.9g}", coefficient.before),
                              fmt::format("{:.9g}", coefficient.after)});
        }
    }
    return result;
}

std::string moved_by(const std::string& name, const std::vector<one_sided_parameter>& moved,
                     const model_comparison& comparison) {
    if (!comparison.torques) {
        return "not evaluated";
    }
    std::vector<std::string> joints;
    for (const one_sided_parameter& parameter : moved) {
        for (const int joint : parameter.name == name ? parameter.joints : std::vector<int>{}) {
            joints.emplace_back(comparison.joint_name(joint));
        }
    }
    return joints.empty() ? "no joint" : fmt::format("{}", fmt::join(joints, ", "));
}

/// Parameters that move the same joints share a row.
table_rows standard_rows(const std::vector<std::string>& names, const std::vector<one_sided_parameter>& moved,
                         const model_comparison& comparison) {
    table_rows result;
    for (const std::string& name : names) {
        const std::string joints = moved_by(name, moved, comparison);
        if (result.empty() || result.back()[1] != joints) {
            result.push_back({name, joints});
        } else {
            result.back()[0] += ", " + name;
        }
    }
    return result;
}

table_rows column_rows(const std::vector<generator::column_move>& moves) {
    const auto range = [](int first, int columns) {
        return columns == 1 ? fmt::format("chi[{}]", first) : fmt::format("chi[{}..{}]", first, first + columns - 1);
    };
    table_rows result;
    for (const generator::column_move& move : moves) {
        result.push_back({move.columns == 1 ? move.first : move.first + " .. " + move.last,
                          range(move.before, move.columns), range(move.after, move.columns)});
    }
    return result;
}

table_rows operation_rows(const std::vector<generator::operations_change>& changes) {
    const auto text = [](const operation_count& count, const char* form) {
        return fmt::format(fmt::runtime(form), count.mul, count.add, count.div);
    };
    table_rows result;
    for (const generator::operations_change& change : changes) {
        const operation_count& old = change.before;
        const operation_count& now = change.after;
        const operation_count more{now.mul - old.mul, now.add - old.add, now.div - old.div, 0};
        constexpr const char* plain = "{} mul {} add {} div";
        const std::string difference = same_counts(old, now) ? "same" : text(more, "{:+} mul {:+} add {:+} div");
        result.push_back(
            {change.function, text(old, plain), text(now, plain), change.in_both ? difference : "only on one side"});
    }
    return result;
}

table_rows largest_rows(const model_comparison& comparison) {
    if (!comparison.torques || comparison.torques->verdict == torque_verdict::same) {
        return {};
    }
    const auto row = [&comparison](const std::string& value, const torque_difference& largest) {
        const auto vector = [](const Eigen::VectorXd& values) {
            return fmt::format("[{:.6g}]", fmt::join(values.data(), values.data() + values.size(), ", "));
        };
        return std::vector<std::string>{value,
                                        comparison.joint_name(largest.joint),
                                        vector(largest.q),
                                        vector(largest.qd),
                                        vector(largest.qdd),
                                        fmt::format("{:.9g}", largest.before),
                                        fmt::format("{:.9g}", largest.after)};
    };
    const torque_difference& absolute = comparison.torques->absolute;
    const torque_difference& relative = comparison.torques->relative;
    const std::string newtons = fmt::format("{:.3g} {}", absolute.value, comparison.unit(absolute.joint));
    const std::string percent = fmt::format("{:.3g} %", 100.0 * relative.value);
    if (absolute.joint == relative.joint) {  // then it is the same state, too
        return {row(newtons + ", " + percent, absolute)};
    }
    return {row(newtons, absolute), row(percent, relative)};
}

}  // namespace

diff_report report(const model_comparison& comparison) {
    const generator::model_difference& difference = comparison.difference;
    const std::string& old_robot = comparison.before.summary.content.robot;
    const std::string& new_robot = comparison.after.summary.content.robot;
    diff_report result{old_robot == new_robot ? new_robot : old_robot + " -> " + new_robot, {}, {}};
    result.summary = {
        {"old", origin(comparison.before)}, {"new", origin(comparison.after)}, {"torque", torque_finding(comparison)}};
    const std::string one_side = comparison.torques ? one_side_finding(*comparison.torques) : "";
    if (!one_side.empty()) {
        result.summary.emplace_back("taken as zero, as one side lacks them", one_side);
    }
    result.summary.emplace_back("base parameters", base_finding(comparison));
    result.summary.emplace_back("regressor columns", column_finding(difference));
    if (!operations_changed(difference)) {
        result.summary.emplace_back("operations", "as before");
    }
    const std::vector<one_sided_parameter> none;
    const auto& only_before = comparison.torques ? comparison.torques->only_before : none;
    const auto& only_after = comparison.torques ? comparison.torques->only_after : none;
    const std::vector<report_table> all = {
        {"effects added", {"effect", "at", "torque"}, effect_rows(difference.effects_added)},
        {"effects removed", {"effect", "at", "torque"}, effect_rows(difference.effects_removed)},
        {"effects changed", {"effect", "entry", "old", "new"}, rows_of(difference.effects_changed, true)},
        {"constants", {"constant", "old", "new"}, rows_of(difference.constants, false)},
        {"gravity", {"", "old", "new"}, rows_of(difference.gravity, false)},
        {"joints", {"joint", "entry", "old", "new"}, rows_of(difference.joints, true)},
        {"loops", {"passive joints", "entry", "old", "new"}, rows_of(difference.loops, true)},
        {"base parameters added", {"name", "unit", "regroups"}, rows_of(difference.base_added)},
        {"base parameters dropped", {"name", "unit", "regroups"}, rows_of(difference.base_dropped)},
        {"base parameters regrouped", {"name", "old", "new"}, regrouping_rows(difference.regrouped)},
        {"operations",
         {"function", "old", "new", "difference"},
         operations_changed(difference) ? operation_rows(difference.operations) : table_rows{}},
        {"regressor columns moved", {"base parameters", "old", "new"}, column_rows(difference.columns), true},
        {"standard parameters added",
         {"name", "moves the torque of"},
         standard_rows(difference.standard_added, only_after, comparison),
         true},
        {"standard parameters dropped",
         {"name", "moved the torque of"},
         standard_rows(difference.standard_dropped, only_before, comparison),
         true},
        {"coefficients of the regrouping",
         {"base parameter", "standard parameter", "old", "new"},
         coefficient_rows(difference.regrouped),
         true},
        {"where the torques differ most",
         {"difference", "joint", "q", "qd", "qdd", "old torque", "new torque"},
         largest_rows(comparison),
         true},
    };
    std::copy_if(all.begin(), all.end(), std::back_inserter(result.tables),
                 [](const report_table& table) { return !table.rows.empty(); });
    return result;
}

std::string to_text(const diff_report& report) {
    std::string text = report.title + "\n";
    for (const auto& [subject, finding] : report.summary) {
        text += fmt::format("  {}: {}\n", subject, finding);
    }
    for (const report_table& table : report.tables) {
        text += "\n" + to_text(table);
    }
    return text;
}

std::string to_markdown(const diff_report& report) {
    std::string text = "### Model of " + escaped(report.title) + "\n\n";
    for (const auto& [subject, finding] : report.summary) {
        text += fmt::format("- **{}**: {}\n", subject, escaped(finding));
    }
    for (const report_table& table : report.tables) {
        const std::string title = fmt::format("{} ({})", table.title, table.rows.size());
        text += table.is_detail
                    ? fmt::format("\n<details><summary>{}</summary>\n\n{}\n</details>\n", title, to_markdown(table))
                    : fmt::format("\n**{}**\n\n{}", title, to_markdown(table));
    }
    return text;
}

}  // namespace idim::cli
