#include "emit/manifest_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "idim/input_error.hpp"
#include "idim/model_interface.h"

namespace idim::generator {

namespace {

using json = nlohmann::ordered_json;

/// Counted up when an entry gets another name or meaning.
constexpr int format = 3;

json joint_json(const manifest_joint& joint) {
    json result = {{"name", joint.name},
                   {"type", joint.type},
                   {"antecedent", joint.antecedent},
                   {"driven", joint.driven},
                   {"row", json::object()}};
    for (const auto& [name, entry] : joint.row) {
        result["row"][name] = entry;
    }
    if (joint.position) {
        result["position"] = {joint.position->first, joint.position->second};
    }
    const std::pair<const char*, const std::optional<double>*> numbers[] = {
        {"velocity", &joint.velocity}, {"effort", &joint.effort}, {"drive_gain", &joint.drive_gain}};
    for (const auto& [name, number] : numbers) {
        if (*number) {
            result[name] = **number;
        }
    }
    return result;
}

json effect_json(const manifest_effect& effect) {
    json result = {{"effect", effect.effect}, {"joints", effect.joints}};
    if (!effect.from.empty()) {
        result["from"] = effect.from;
    }
    for (const auto& [name, value] : effect.shape) {
        result["shape"][name] = value;
    }
    result["torque"] = effect.torque;
    return result;
}

json to_json(const manifest& content) {
    json result = {{"generator", content.generator},   {"format", format},         {"interface", IDIM_MODEL_ABI},
                   {"robot", content.robot},           {"target", content.target}, {"cost", content.cost},
                   {"input_hash", content.input_hash}, {"files", content.files},   {"gravity", content.gravity},
                   {"constants", json::object()},      {"joints", json::array()},  {"effects", json::array()},
                   {"operations", json::object()}};
    for (const auto& [name, value] : content.constants) {
        result["constants"][name] = value;
    }
    for (const manifest_joint& joint : content.joints) {
        result["joints"].push_back(joint_json(joint));
    }
    for (const manifest_effect& effect : content.effects) {
        result["effects"].push_back(effect_json(effect));
    }
    for (const auto& [name, count] : content.operations) {
        result["operations"][name] = {
            {"mul", count.mul}, {"add", count.add}, {"div", count.div}, {"functions", count.functions}};
    }
    return result;
}

/// The elements of a list or map, one a line.
std::string lines_of(const json& value) {
    std::string text;
    for (const auto& [key, element] : value.items()) {
        text += text.empty() ? "\n    " : ",\n    ";
        text += (value.is_object() ? json(key).dump() + ": " : "") + element.dump();
    }
    return text.empty() ? "" : text + "\n  ";
}

/// Values of a JSON text that may be anything, with the place they stand in for messages.
class json_entry {
  public:
    json_entry(const json& value, input_location where) : value_(value), where_(std::move(where)) {}

    json_entry at(const std::string& key) const {
        if (const std::optional<json_entry> found = find(key)) {
            return *found;
        }
        const json_entry missing(value_, place(key));
        missing.reject("an entry");
    }
    std::optional<json_entry> find(const std::string& key) const {
        if (!value_.is_object()) {
            reject("a map");
        }
        const auto found = value_.find(key);
        return found == value_.end() ? std::nullopt : std::optional(json_entry(*found, place(key)));
    }
    std::vector<json_entry> items() const {
        if (!value_.is_array()) {
            reject("a list");
        }
        std::vector<json_entry> result;
        for (const json& element : value_) {
            result.emplace_back(element, place(std::to_string(result.size() + 1)));
        }
        return result;
    }
    std::vector<std::pair<std::string, json_entry>> entries() const {
        if (!value_.is_object()) {
            reject("a map");
        }
        std::vector<std::pair<std::string, json_entry>> result;
        for (const auto& [key, element] : value_.items()) {
            result.emplace_back(checked(key), json_entry(element, place(key)));
        }
        return result;
    }
    std::string text() const {
        if (!value_.is_string()) {
            reject("a text");
        }
        return checked(value_.get<std::string>());
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> result;
        for (const json_entry& item : items()) {
            result.push_back(item.text());
        }
        return result;
    }
    double number() const {
        if (!value_.is_number() || !std::isfinite(value_.get<double>())) {
            reject("a number");
        }
        return value_.get<double>();
    }
    bool flag() const {
        if (!value_.is_boolean()) {
            reject("true or false");
        }
        return value_.get<bool>();
    }
    int count() const {
        constexpr double most = 1e9;
        if (!value_.is_number_integer() || value_.get<double>() < 0.0 || value_.get<double>() > most) {
            reject("a count");
        }
        return value_.get<int>();
    }
    [[noreturn]] void reject(const std::string& expected) const {
        throw input_error(where_,
                          "expected " + expected + ", written by another version of idim? regenerate the folder");
    }

  private:
    input_location place(const std::string& key) const {
        return {where_.file, where_.line, where_.field + (where_.field.empty() ? "" : ".") + key};
    }
    /// What is read is shown to people, and a control character would be an order to their terminal.
    std::string checked(const std::string& text) const {
        const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
        if (std::any_of(text.begin(), text.end(), is_control)) {
            reject("text without control characters");
        }
        return text;
    }

    const json& value_;
    input_location where_;
};

std::optional<double> optional_number(const json_entry& entry, const std::string& key) {
    const auto found = entry.find(key);
    return found ? std::optional(found->number()) : std::nullopt;
}

manifest_joint read_joint(const json_entry& entry) {
    manifest_joint joint;
    joint.name = entry.at("name").text();
    joint.type = entry.at("type").text();
    if (joint.type != "revolute" && joint.type != "prismatic" && joint.type != "fixed") {
        entry.at("type").reject("revolute, prismatic or fixed");
    }
    joint.antecedent = entry.at("antecedent").text();
    joint.driven = entry.at("driven").flag();
    for (const auto& [name, value] : entry.at("row").entries()) {
        joint.row.emplace_back(name, value.text());
    }
    if (const auto position = entry.find("position")) {
        const std::vector<json_entry> limits = position->items();
        if (limits.size() != 2 || limits[0].number() > limits[1].number()) {
            position->reject("two numbers, the smaller first");
        }
        joint.position = {limits[0].number(), limits[1].number()};
    }
    joint.velocity = optional_number(entry, "velocity");
    joint.effort = optional_number(entry, "effort");
    joint.drive_gain = optional_number(entry, "drive_gain");
    return joint;
}

manifest_effect read_effect(const json_entry& entry) {
    manifest_effect effect;
    effect.effect = entry.at("effect").text();
    effect.joints = entry.at("joints").texts();
    if (const auto from = entry.find("from")) {
        effect.from = from->texts();
        if (effect.from.size() != effect.joints.size()) {
            from->reject("as many joints as in \"joints\"");
        }
    }
    if (const auto shape = entry.find("shape")) {
        for (const auto& [name, value] : shape->entries()) {
            effect.shape.emplace_back(name, value.number());
        }
    }
    effect.torque = entry.at("torque").text();
    return effect;
}

void check_versions(const json_entry& root) {
    if (root.at("format").count() != format) {
        root.at("format").reject(std::to_string(format));
    }
    if (root.at("interface").count() != IDIM_MODEL_ABI) {
        root.at("interface").reject(std::to_string(IDIM_MODEL_ABI));
    }
}

}  // namespace

std::string to_json_text(const manifest& content) {
    const json entries = to_json(content);
    std::string text;
    for (const auto& [key, value] : entries.items()) {
        text += (text.empty() ? "{\n  " : ",\n  ") + json(key).dump() + ": ";
        text += value.is_array()    ? "[" + lines_of(value) + "]"
                : value.is_object() ? "{" + lines_of(value) + "}"
                                    : value.dump();
    }
    return text + "\n}\n";
}

manifest read_manifest(const std::string& text, const std::string& file) {
    const json content = json::parse(text, nullptr, false);
    const json_entry root(content, {file, 0, ""});
    if (content.is_discarded()) {
        root.reject("JSON");
    }
    check_versions(root);
    manifest result;
    result.generator = root.at("generator").text();
    result.robot = root.at("robot").text();
    result.target = root.at("target").text();
    result.cost = root.at("cost").text();
    result.input_hash = root.at("input_hash").text();
    result.files = root.at("files").texts();
    result.gravity = root.at("gravity").texts();
    for (const auto& [name, value] : root.at("constants").entries()) {
        result.constants.emplace_back(name, value.number());
    }
    for (const json_entry& joint : root.at("joints").items()) {
        result.joints.push_back(read_joint(joint));
    }
    for (const json_entry& effect : root.at("effects").items()) {
        result.effects.push_back(read_effect(effect));
    }
    for (const auto& [name, count] : root.at("operations").entries()) {
        result.operations.emplace_back(name, operation_count{count.at("mul").count(), count.at("add").count(),
                                                             count.at("div").count(), count.at("functions").count()});
    }
    return result;
}

}  // namespace idim::generator
