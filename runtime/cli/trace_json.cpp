#include "trace_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace idim::cli {

namespace {

std::vector<std::string> names_of(const std::vector<int>& joints, const loaded_robot& robot) {
    std::vector<std::string> names;
    for (const int j : joints) {
        names.push_back(joint_name(robot, j));
    }
    return names;
}

json place_json(const effect_place& place, const loaded_robot& robot) {
    json content = {{"effect", place.effect}, {"joints", names_of(place.joints, robot)}};
    if (place.from) {
        content["from"] = names_of({*place.from}, robot);
    }
    return content;
}

json places_json(const std::vector<effect_place>& places, const loaded_robot& robot) {
    json list = json::array();
    for (const effect_place& place : places) {
        list.push_back(place_json(place, robot));
    }
    return list;
}

json step_json(const trace_step& step, const loaded_robot& robot) {
    json content = place_json(step.place, robot);
    json parameters = json::object();
    for (const effect_parameter& parameter : step.parameters) {
        parameters[parameter.name] = {
            {"value", finite(parameter.value)}, {"std", finite(parameter.std)}, {"unit", parameter.unit}};
    }
    content["parameters"] = parameters;
    if (!step.torque.empty()) {
        content["torque"] = step.torque;
    }
    content["p_value"] = step.p_value;
    content["explained_fraction"] = step.explained_fraction;
    content["confusable_with"] = places_json(step.confusable_with, robot);
    content["before"] = to_json(step.before, robot);
    content["after"] = to_json(step.after, robot);
    return content;
}

json candidates_json(const effect_trace& trace, const loaded_robot& robot) {
    json list = json::array();
    for (const trace_candidate& candidate : trace.candidates) {
        json entry = place_json(candidate.place, robot);
        entry["p_value"] = candidate.p_value;
        entry["explained_fraction"] = candidate.explained_fraction;
        entry["f_statistic"] = finite(candidate.f_statistic);
        entry["correlation_length"] = candidate.correlation_length;
        entry["held_back_z"] = finite(candidate.held_back_z);
        entry["moving_z"] = finite(candidate.moving_z);
        entry["values"] = candidate.values;
        entry["objection"] = candidate.objection.empty() ? json(nullptr) : json(candidate.objection);
        list.push_back(entry);
    }
    return list;
}

json unexplained_json(const effect_trace& trace, const loaded_robot& robot) {
    json list = json::array();
    for (const unexplained_structure& structure : trace.unexplained) {
        list.push_back({{"joint", joint_name(robot, structure.joint)},
                        {"signals", structure.signals},
                        {"explained_fraction", structure.explained_fraction},
                        {"proposed", structure.proposed.empty() ? json(nullptr) : json(structure.proposed)}});
    }
    return list;
}

json hidden_json(const effect_trace& trace, const loaded_robot& robot) {
    json list = json::array();
    for (const hidden_effect& hidden : trace.not_identifiable) {
        list.push_back(place_json(hidden.place, robot));
        list.back()["reason"] = hidden.reason;
    }
    return list;
}

json unsupported_json(const effect_trace& trace, const loaded_robot& robot) {
    json list = json::array();
    for (const unsupported_term& term : trace.unsupported) {
        json entry = place_json(term.place, robot);
        entry["parameters"] = term.parameters;
        entry["p_value"] = term.p_value;
        entry["without"] = to_json(term.without, robot);
        list.push_back(entry);
    }
    return list;
}

json floor_json(const noise_floor& floor) {
    if (floor.rms.size() == 0) {
        return nullptr;
    }
    return {{"from", floor.from}, {"rms", std::vector<double>(floor.rms.data(), floor.rms.data() + floor.rms.size())}};
}

}  // namespace

json to_json(const trace_errors& errors, const loaded_robot& robot) {
    return {{"identification", to_json(errors.identification, robot)},
            {"validation", to_json(errors.validation, robot)}};
}

std::string verdict_of(const effect_trace& trace) {
    if (!trace.steps.empty()) {
        return "effects_added";
    }
    return trace.unexplained.empty() ? "no_missing_effect" : "unexplained_residual";
}

std::string describe(const effect_place& place, const loaded_robot& robot) {
    std::string text = fmt::format("{} at {}", place.effect, fmt::join(names_of(place.joints, robot), ", "));
    if (place.from) {
        text += " from " + joint_name(robot, *place.from);
    }
    return text;
}

std::string describe(const effect_parameter& parameter) {
    if (!std::isfinite(parameter.value)) {
        return fmt::format("{}: this motion does not show it apart from the model's own parameters", parameter.name);
    }
    const std::string deviation = std::isfinite(parameter.std) ? fmt::format(" (std {:.2g})", parameter.std) : "";
    return fmt::format("{} = {:.5g}{} {}", parameter.name, parameter.value, deviation, parameter.unit);
}

std::string describe(const unsupported_term& term, const trace_errors& with, const loaded_robot& robot) {
    return fmt::format(
        "{} ({}), p {:.2g}; errors without it {:.3f} % fitted, {:.3f} % held back, with all terms {:.3f} % and {:.3f} "
        "%",
        describe(term.place, robot), fmt::join(term.parameters, ", "), term.p_value,
        100.0 * term.without.identification.relative_error, 100.0 * term.without.validation.relative_error,
        100.0 * with.identification.relative_error, 100.0 * with.validation.relative_error);
}

json to_json(const effect_trace& trace, const traced_robot& traced) {
    const loaded_robot& robot = traced.robot;
    json steps = json::array();
    for (const trace_step& step : trace.steps) {
        steps.push_back(step_json(step, robot));
    }
    return {{"noise_floor", floor_json(trace.floor)},
            {"band", traced.filter.band(traced.fitted.front().rate)},
            {"filter", to_json(traced.filter)},
            {"held_back", traced.held_back_note.empty() ? json(nullptr) : json(traced.held_back_note)},
            {"alignment", trace.alignment},
            {"tests", trace.tests},
            {"steps", steps},
            {"candidates", candidates_json(trace, robot)},
            {"not_identifiable", hidden_json(trace, robot)},
            {"unsupported", unsupported_json(trace, robot)},
            {"unexplained", unexplained_json(trace, robot)}};
}

}  // namespace idim::cli
