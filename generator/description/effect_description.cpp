#include "description/effect_description.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>

#include "description/identifier.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

namespace fs = std::filesystem;

effect_scope read_scope(const yaml_value& written) {
    const std::string text = written.text("joint, pair or robot");
    if (text == "joint") {
        return effect_scope::joint;
    }
    if (text == "pair") {
        return effect_scope::pair;
    }
    if (text != "robot") {
        written.reject("joint, pair or robot");
    }
    return effect_scope::robot;
}

bool read_acts_on_both(const yaml_value& written, effect_scope scope) {
    const std::string text = written.text("one or both");
    if (scope != effect_scope::pair || (text != "one" && text != "both")) {
        written.reject("one or both, and only where per is pair");
    }
    return text == "both";
}

/// Units stand in comments of generated code, so nothing that ends or starts one passes.
std::string read_unit(const yaml_fields& fields) {
    constexpr const char* expected = "a unit such as N*m, or 1";
    constexpr std::size_t longest_unit = 40;
    const yaml_value written = fields.require("unit", expected);
    const std::string unit = written.text(expected);
    const bool plain = std::all_of(unit.begin(), unit.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("*/^()-. %").find(c) != std::string_view::npos;
    });
    const auto holds = [&](const char* mark) { return unit.find(mark) != std::string::npos; };
    if (!plain || unit.size() > longest_unit || holds("*/") || holds("/*") || holds("//")) {
        written.reject(expected);
    }
    return unit;
}

std::vector<linear_coefficient> read_linear(const yaml_fields& effect) {
    std::vector<linear_coefficient> result;
    if (const auto written = effect.find("linear")) {
        for (const auto& [name, value] : written->entries("a map of coefficients to {unit, min}")) {
            linear_coefficient coefficient;
            coefficient.name = checked_symbol(name, value.where());
            const yaml_fields fields(value, {"unit", "min"});
            coefficient.unit = read_unit(fields);
            if (const auto min = fields.find("min")) {
                coefficient.min = min->number();
            }
            result.push_back(coefficient);
        }
    }
    return result;
}

std::pair<double, double> read_range(const yaml_value& written) {
    const auto bounds = written.items("a list [lowest, highest]");
    if (bounds.size() != 2) {
        throw input_error(written.where(),
                          "expected a list [lowest, highest], got " + std::to_string(bounds.size()) + " entries");
    }
    const std::pair<double, double> range{bounds[0].number(), bounds[1].number()};
    if (range.first >= range.second) {
        throw input_error(written.where(), "expected [lowest, highest] with the lowest first");
    }
    return range;
}

std::vector<shape_coefficient> read_shape(const yaml_fields& effect, const std::vector<linear_coefficient>& linear) {
    std::vector<shape_coefficient> result;
    if (const auto written = effect.find("shape")) {
        for (const auto& [name, value] : written->entries("a map of coefficients to {unit, range}")) {
            shape_coefficient coefficient;
            coefficient.name = checked_symbol(name, value.where());
            for (const linear_coefficient& other : linear) {
                if (other.name == name) {
                    throw input_error(value.where(), quote(name) + " is already a linear coefficient");
                }
            }
            const yaml_fields fields(value, {"unit", "range"});
            coefficient.unit = read_unit(fields);
            coefficient.range = read_range(fields.require("range", "a list [lowest, highest]"));
            result.push_back(coefficient);
        }
    }
    return result;
}

effect_kind read_kind(const yaml_value& written) {
    static const std::map<std::string, effect_kind> kinds = {
        {"expression", effect_kind::expression}, {"delay", effect_kind::delay}, {"gain", effect_kind::gain},
        {"elasticity", effect_kind::elasticity}, {"tilt", effect_kind::tilt},   {"payload", effect_kind::payload}};
    constexpr const char* expected = "expression, delay, gain, elasticity, tilt or payload";
    const auto found = kinds.find(written.text(expected));
    if (found == kinds.end()) {
        written.reject(expected);
    }
    return found->second;
}

bool read_yes(const yaml_value& written) {
    const std::string text = written.text("true or false");
    if (text != "true" && text != "false") {
        written.reject("true or false");
    }
    return text == "true";
}

std::vector<effect_state> read_states(const yaml_fields& effect) {
    std::vector<effect_state> result;
    if (const auto written = effect.find("state")) {
        for (const auto& [name, value] : written->entries("a map of states to {start, next}")) {
            effect_state state;
            state.name = checked_symbol(name, value.where());
            const yaml_fields fields(value, {"start", "next"});
            if (const auto start = fields.find("start")) {
                state.start = {start->expression(), start->where()};
            }
            const yaml_value next = fields.require("next", "an expression of the signals, dt and the states");
            state.next = {next.expression(), next.where()};
            result.push_back(state);
        }
    }
    return result;
}

void read_torque(const yaml_fields& fields, effect_description& effect) {
    if (const auto kind = fields.find("kind")) {
        effect.kind = read_kind(*kind);
    }
    if (effect.kind != effect_kind::expression) {
        return;
    }
    const yaml_value torque = fields.require("torque", "an expression of the signals and coefficients");
    effect.torque = {torque.expression(), torque.where()};
    if (const auto other = fields.find("torque_without_temperature")) {
        effect.torque_without_temperature = {other->expression(), other->where()};
    }
}

}  // namespace

std::string law_of(const effect_description& effect) {
    static const std::map<effect_kind, std::string> kinds = {
        {effect_kind::delay, "torque(t - Td)"},
        {effect_kind::gain, "(1 + Ke)*torque"},
        {effect_kind::elasticity,
         "tau_rigid = K*(q of the motor - q of the link) + D*(qd of the motor - qd of the link)"},
        {effect_kind::tilt,
         "gravity turned by tilt_x about x, then by tilt_y about y, then by tilt_z about z of the base"},
        {effect_kind::payload, "ten inertial parameters at the link from t0 to t1"}};
    if (const auto kind = kinds.find(effect.kind); kind != kinds.end()) {
        return kind->second;
    }
    std::string text = effect.torque.text;
    if (effect.torque_without_temperature) {
        text += "; without temperature " + effect.torque_without_temperature->text;
    }
    for (const effect_state& state : effect.states) {
        text += "; " + state.name + " starts at " + state.start.text + ", then " + state.next.text;
    }
    return text + (effect.per_log ? "; coefficients of every log" : "");
}

effect_description read_effect(const std::string& file) {
    const yaml_fields fields(read_yaml(file),
                             {"effect", "per", "acts_on", "kind", "torque", "torque_without_temperature", "per_log",
                              "state", "linear", "shape", "about", "proposed"});
    effect_description effect;
    effect.file = file;
    const yaml_value name = fields.require("effect", "the name of the effect");
    effect.name = checked_name(name.text("the name of the effect"), name.where());
    if (const std::string stem = fs::path(file).stem().string(); effect.name != stem) {
        name.reject(quote(stem) + ", the name of the file");
    }
    effect.scope = read_scope(fields.require("per", "joint, pair or robot"));
    if (const auto acts_on = fields.find("acts_on")) {
        effect.acts_on_both = read_acts_on_both(*acts_on, effect.scope);
    }
    read_torque(fields, effect);
    if (const auto per_log = fields.find("per_log")) {
        effect.per_log = read_yes(*per_log);
    }
    effect.states = read_states(fields);
    effect.linear = read_linear(fields);
    effect.shape = read_shape(fields, effect.linear);
    if (effect.linear.empty() && effect.shape.empty()) {
        throw input_error({file, fields.where().line, "linear"}, "missing, expected at least one coefficient");
    }
    if (const auto proposed = fields.find("proposed")) {
        read_yes(*proposed);  // for those who read the file: no published effect
    }
    if (const auto about = fields.find("about")) {
        effect.about = about->paragraph("a sentence");
    }
    return effect;
}

effect_description find_effect(const effect_use& use, const robot_description& robot,
                               const std::string& effects_folder) {
    const fs::path beside = fs::path(robot.file).parent_path();
    std::string searched;
    for (const fs::path& folder :
         {beside.empty() ? fs::path(".") : beside, beside / "effects", fs::path(effects_folder)}) {
        const fs::path candidate = folder / (use.effect + ".yaml");
        std::error_code ignored;
        if (fs::exists(candidate, ignored)) {
            return read_effect(candidate.string());
        }
        searched += (searched.empty() ? "" : ", ") + folder.string();
    }
    throw input_error(use.where, "no effect " + quote(use.effect) + ", searched " + searched);
}

}  // namespace idim::generator
