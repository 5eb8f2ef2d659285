#include "diff_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace idim::cli {

namespace {

using generator::entry_change;
using generator::operation_count;
using generator::parameter_context;
using rows = std::vector<std::vector<std::string>>;

const char* joint_name(const model_comparison& comparison, int joint) {
    return comparison.after.compiled.interface().joint_names[joint];
}

const char* unit_of(const model_comparison& comparison, int joint) {
    return comparison.after.compiled.interface().joint_is_prismatic[joint] != 0 ? "N" : "N*m";
}

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
                torques.states, relative.value, joint_name(comparison, relative.joint));
        case torque_verdict::different:
            break;
    }
    return fmt::format(
        "different, at {} random states with standard parameters from [-1, 1] by up to {:.3g} {} at {} and {:.3g} % of "
        "the largest torque of {}",
        torques.states, absolute.value, unit_of(comparison, absolute.joint), joint_name(comparison, absolute.joint),
        100.0 * relative.value, joint_name(comparison, relative.joint));
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

rows rows_of(const std::vector<parameter_context>& parameters) {
    rows result;
    for (const parameter_context& parameter : parameters) {
        result.push_back({parameter.name, parameter.unit, parameter.regroups});
    }
    return result;
}

rows effect_rows(const std::vector<generator::manifest_effect>& effects) {
    rows result;
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

rows rows_of(const std::vector<entry_change>& changes, bool with_field) {
    rows result;
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

rows regrouping_rows(const std::vector<generator::regrouping_change>& changes) {
    rows result;
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

rows coefficient_rows(const std::vector<generator::regrouping_change>& changes) {
    rows result;
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
            joints.emplace_back(joint_name(comparison, joint));
        }
    }
    return joints.empty() ? "no joint" : fmt::format("{}", fmt::join(joints, ", "));
}

/// Parameters that move the same joints share a row.
rows standard_rows(const std::vector<std::string>& names, const std::vector<one_sided_parameter>& moved,
                   const model_comparison& comparison) {
    rows result;
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

rows column_rows(const std::vector<generator::column_move>& moves) {
    const auto range = [](int first, int columns) {
        return columns == 1 ? fmt::format("chi[{}]", first) : fmt::format("chi[{}..{}]", first, first + columns - 1);
    };
    rows result;
    for (const generator::column_move& move : moves) {
        result.push_back({move.columns == 1 ? move.first : move.first + " .. " + move.last,
                          range(move.before, move.columns), range(move.after, move.columns)});
    }
    return result;
}

rows operation_rows(const std::vector<generator::operations_change>& changes) {
    const auto text = [](const operation_count& count, const char* form) {
        return fmt::format(fmt::runtime(form), count.mul, count.add, count.div);
    };
    rows result;
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

rows largest_rows(const model_comparison& comparison) {
    if (!comparison.torques || comparison.torques->verdict == torque_verdict::same) {
        return {};
    }
    const auto row = [&comparison](const std::string& value, const torque_difference& largest) {
        const auto vector = [](const Eigen::VectorXd& values) {
            return fmt::format("[{:.6g}]", fmt::join(values.data(), values.data() + values.size(), ", "));
        };
        return std::vector<std::string>{value,
                                        joint_name(comparison, largest.joint),
                                        vector(largest.q),
                                        vector(largest.qd),
                                        vector(largest.qdd),
                                        fmt::format("{:.9g}", largest.before),
                                        fmt::format("{:.9g}", largest.after)};
    };
    const torque_difference& absolute = comparison.torques->absolute;
    const torque_difference& relative = comparison.torques->relative;
    const std::string newtons = fmt::format("{:.3g} {}", absolute.value, unit_of(comparison, absolute.joint));
    const std::string percent = fmt::format("{:.3g} %", 100.0 * relative.value);
    if (absolute.joint == relative.joint) {  // then it is the same state, too
        return {row(newtons + ", " + percent, absolute)};
    }
    return {row(newtons, absolute), row(percent, relative)};
}

std::string code(std::string text) {
    std::replace(text.begin(), text.end(), '`', '\'');
    std::string result;
    for (const char c : text) {
        result += c == '|' ? "\\|" : std::string(1, c);
    }
    return "`" + result + "`";
}

/// Text in which nothing is markup.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_markup = std::string("\\`*_{}[]<>#|~&!").find(c) != std::string::npos;
        result += is_markup ? std::string("\\") + c : std::string(1, c);
    }
    return result;
}

/// Rows that are too long to stand beside each other: an entry a line.
std::string listed(const report_table& table) {
    std::string text;
    for (const auto& row : table.rows) {
        text += "  " + row[0] + "\n";
        for (std::size_t c = 1; c < row.size(); ++c) {
            text += fmt::format("    {}: {}\n", table.columns[c], row[c]);
        }
    }
    return text;
}

std::string text_table(const report_table& table) {
    constexpr std::size_t widest = 120;
    rows lines = {table.columns};
    lines.insert(lines.end(), table.rows.begin(), table.rows.end());
    std::vector<std::size_t> widths(table.columns.size(), 0);
    for (const auto& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            widths[c] = std::max(widths[c], line[c].size());
        }
    }
    if (std::accumulate(widths.begin(), widths.end(), 2 * widths.size()) > widest) {
        return table.title + "\n" + listed(table);
    }
    std::string text = table.title + "\n";
    for (const auto& line : lines) {
        std::string row;
        for (std::size_t c = 0; c < line.size(); ++c) {
            row += fmt::format("  {:<{}}", line[c], widths[c]);
        }
        text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string markdown_table(const report_table& table) {
    std::string text = fmt::format("| {} |\n|{}\n", fmt::join(table.columns, " | "),
                                   fmt::join(std::vector<std::string>(table.columns.size(), "---|"), ""));
    for (const auto& row : table.rows) {
        for (const std::string& cell : row) {
            text += "| " + code(cell) + " ";
        }
        text += "|\n";
    }
    return text;
}

json to_json(const parameter_context& parameter) {
    return {{"name", parameter.name}, {"regroups", parameter.regroups}, {"unit", parameter.unit}};
}

json to_json(const std::vector<parameter_context>& parameters) {
    json list = json::array();
    for (const parameter_context& parameter : parameters) {
        list.push_back(to_json(parameter));
    }
    return list;
}

json to_json(const std::vector<generator::regrouping_change>& changes) {
    json list = json::array();
    for (const generator::regrouping_change& change : changes) {
        json coefficients = json::array();
        for (const generator::coefficient_change& coefficient : change.coefficients) {
            coefficients.push_back(
                {{"standard", coefficient.standard}, {"old", coefficient.before}, {"new", coefficient.after}});
        }
        list.push_back(
            {{"old", to_json(change.before)}, {"new", to_json(change.after)}, {"coefficients", coefficients}});
    }
    return list;
}

json to_json(const std::vector<entry_change>& changes, const char* what) {
    json list = json::array();
    for (const entry_change& change : changes) {
        json entry = {{what, change.what}};
        if (!change.field.empty()) {
            entry["field"] = change.field;
        }
        entry["old"] = change.before.empty() ? json(nullptr) : json(change.before);
        entry["new"] = change.after.empty() ? json(nullptr) : json(change.after);
        list.push_back(entry);
    }
    return list;
}

json to_json(const std::vector<generator::manifest_effect>& effects) {
    json list = json::array();
    for (const generator::manifest_effect& effect : effects) {
        json entry = {{"effect", effect.effect}, {"joints", effect.joints}, {"torque", effect.torque}};
        if (!effect.from.empty()) {
            entry["from"] = effect.from;
        }
        for (const auto& [name, value] : effect.shape) {
            entry["shape"][name] = value;
        }
        list.push_back(entry);
    }
    return list;
}

json to_json(const operation_count& count) {
    return {{"mul", count.mul}, {"add", count.add}, {"div", count.div}, {"functions", count.functions}};
}

json operations_json(const std::vector<generator::operations_change>& changes) {
    json functions = json::object();
    for (const generator::operations_change& change : changes) {
        const operation_count& old = change.before;
        const operation_count& now = change.after;
        functions[change.function] = {
            {"old", to_json(old)},
            {"new", to_json(now)},
            {"difference", to_json(operation_count{now.mul - old.mul, now.add - old.add, now.div - old.div,
                                                   now.functions - old.functions})}};
    }
    return functions;
}

json columns_json(const model_comparison& comparison) {
    const auto names = [](const generator::model_summary& model) {
        json list = json::array();
        for (const auto& base : model.base) {
            list.push_back(base.parameter.name);
        }
        return list;
    };
    json moved = json::array();
    for (const generator::column_move& move : comparison.difference.columns) {
        moved.push_back({{"first", move.first},
                         {"last", move.last},
                         {"columns", move.columns},
                         {"old", move.before},
                         {"new", move.after}});
    }
    return {{"old", names(comparison.before.summary)}, {"new", names(comparison.after.summary)}, {"moved", moved}};
}

json to_json(const torque_difference& largest, const model_comparison& comparison) {
    const auto vector = [](const Eigen::VectorXd& values) {
        return json(std::vector<double>(values.data(), values.data() + values.size()));
    };
    return {{"difference", largest.value}, {"joint", joint_name(comparison, largest.joint)},
            {"q", vector(largest.q)},      {"qd", vector(largest.qd)},
            {"qdd", vector(largest.qdd)},  {"old", largest.before},
            {"new", largest.after}};
}

json to_json(const std::vector<one_sided_parameter>& parameters, const model_comparison& comparison) {
    json list = json::array();
    for (const one_sided_parameter& parameter : parameters) {
        json joints = json::array();
        for (const int joint : parameter.joints) {
            joints.push_back(joint_name(comparison, joint));
        }
        list.push_back({{"name", parameter.name}, {"moves", joints}});
    }
    return list;
}

json torque_json(const model_comparison& comparison) {
    if (!comparison.torques) {
        return {{"verdict", "not_comparable"}, {"reason", *comparison.difference.not_comparable}};
    }
    const torque_comparison& torques = *comparison.torques;
    static constexpr const char* verdicts[] = {"same", "same_up_to_rounding", "different"};
    return {{"verdict", verdicts[static_cast<int>(torques.verdict)]},
            {"states", torques.states},
            {"seed", torques.seed},
            {"absolute", to_json(torques.absolute, comparison)},
            {"relative", to_json(torques.relative, comparison)},
            {"only_old", to_json(torques.only_before, comparison)},
            {"only_new", to_json(torques.only_after, comparison)}};
}

json origin_json(const compared_model& model) {
    const generator::manifest& content = model.summary.content;
    return {{"path", model.path},
            {"robot", content.robot},
            {"generator", content.generator},
            {"input_hash", content.input_hash},
            {"base_parameters", model.summary.base.size()},
            {"standard_parameters", model.summary.standard.size()}};
}

}  // namespace

bool model_comparison::same() const {
    return difference.empty() && torques->verdict != torque_verdict::different;
}

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
         operations_changed(difference) ? operation_rows(difference.operations) : rows{}},
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
        text += "\n" + text_table(table);
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
                    ? fmt::format("\n<details><summary>{}</summary>\n\n{}\n</details>\n", title, markdown_table(table))
                    : fmt::format("\n**{}**\n\n{}", title, markdown_table(table));
    }
    return text;
}

json to_json(const model_comparison& comparison) {
    const generator::model_difference& difference = comparison.difference;
    return {{"old", origin_json(comparison.before)},
            {"new", origin_json(comparison.after)},
            {"same", comparison.same()},
            {"torque", torque_json(comparison)},
            {"base_parameters",
             {{"added", to_json(difference.base_added)},
              {"dropped", to_json(difference.base_dropped)},
              {"regrouped", to_json(difference.regrouped)}}},
            {"standard_parameters", {{"added", difference.standard_added}, {"dropped", difference.standard_dropped}}},
            {"effects",
             {{"added", to_json(difference.effects_added)},
              {"removed", to_json(difference.effects_removed)},
              {"changed", to_json(difference.effects_changed, "effect")}}},
            {"constants", to_json(difference.constants, "constant")},
            {"gravity", to_json(difference.gravity, "gravity")},
            {"joints", to_json(difference.joints, "joint")},
            {"loops", to_json(difference.loops, "loop")},
            {"regressor_columns", columns_json(comparison)},
            {"operations", operations_json(difference.operations)}};
}

}  // namespace idim::cli
