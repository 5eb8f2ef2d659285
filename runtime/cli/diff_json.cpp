#include "diff_json.hpp"

#include <string>
#include <vector>

namespace idim::cli {

namespace {

using generator::entry_change;
using generator::operation_count;
using generator::parameter_context;

json json_of(const parameter_context& parameter) {
    return {{"name", parameter.name}, {"regroups", parameter.regroups}, {"unit", parameter.unit}};
}

json json_of(const std::vector<parameter_context>& parameters) {
    json list = json::array();
    for (const parameter_context& parameter : parameters) {
        list.push_back(json_of(parameter));
    }
    return list;
}

json json_of(const std::vector<generator::regrouping_change>& changes) {
    json list = json::array();
    for (const generator::regrouping_change& change : changes) {
        json coefficients = json::array();
        for (const generator::coefficient_change& coefficient : change.coefficients) {
            coefficients.push_back(
                {{"standard", coefficient.standard}, {"old", coefficient.before}, {"new", coefficient.after}});
        }
        list.push_back(
            {{"old", json_of(change.before)}, {"new", json_of(change.after)}, {"coefficients", coefficients}});
    }
    return list;
}

json json_of(const std::vector<entry_change>& changes, const char* what) {
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

json json_of(const std::vector<generator::manifest_effect>& effects) {
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

json json_of(const operation_count& count) {
    return {{"mul", count.mul}, {"add", count.add}, {"div", count.div}, {"functions", count.functions}};
}

json operations_json(const std::vector<generator::operations_change>& changes) {
    json functions = json::object();
    for (const generator::operations_change& change : changes) {
        const operation_count& old = change.before;
        const operation_count& now = change.after;
        functions[change.function] = {
            {"old", json_of(old)},
            {"new", json_of(now)},
            {"difference", json_of(operation_count{now.mul - old.mul, now.add - old.add, now.div - old.div,
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

json json_of(const torque_difference& largest, const model_comparison& comparison) {
    const auto vector = [](const Eigen::VectorXd& values) {
        return json(std::vector<double>(values.data(), values.data() + values.size()));
    };
    return {{"difference", largest.value}, {"joint", comparison.joint_name(largest.joint)},
            {"q", vector(largest.q)},      {"qd", vector(largest.qd)},
            {"qdd", vector(largest.qdd)},  {"old", largest.before},
            {"new", largest.after}};
}

json json_of(const std::vector<one_sided_parameter>& parameters, const model_comparison& comparison) {
    json list = json::array();
    for (const one_sided_parameter& parameter : parameters) {
        json joints = json::array();
        for (const int joint : parameter.joints) {
            joints.push_back(comparison.joint_name(joint));
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
            {"absolute", json_of(torques.absolute, comparison)},
            {"relative", json_of(torques.relative, comparison)},
            {"only_old", json_of(torques.only_before, comparison)},
            {"only_new", json_of(torques.only_after, comparison)}};
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

json to_json(const model_comparison& comparison) {
    const generator::model_difference& difference = comparison.difference;
    return {{"old", origin_json(comparison.before)},
            {"new", origin_json(comparison.after)},
            {"same", comparison.same()},
            {"torque", torque_json(comparison)},
            {"base_parameters",
             {{"added", json_of(difference.base_added)},
              {"dropped", json_of(difference.base_dropped)},
              {"regrouped", json_of(difference.regrouped)}}},
            {"standard_parameters", {{"added", difference.standard_added}, {"dropped", difference.standard_dropped}}},
            {"effects",
             {{"added", json_of(difference.effects_added)},
              {"removed", json_of(difference.effects_removed)},
              {"changed", json_of(difference.effects_changed, "effect")}}},
            {"constants", json_of(difference.constants, "constant")},
            {"gravity", json_of(difference.gravity, "gravity")},
            {"joints", json_of(difference.joints, "joint")},
            {"loops", json_of(difference.loops, "loop")},
            {"regressor_columns", columns_json(comparison)},
            {"operations", operations_json(difference.operations)}};
}

}  // namespace idim::cli
