#include "emit/manifest_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "emit/json_entry.hpp"
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

json loop_json(const manifest_loop& loop) {
    json result = {{"cut", json::array()}, {"passive", loop.passive}, {"assembly", loop.assembly}};
    for (const auto& [link, at] : loop.cut) {
        result["cut"].push_back({{"link", link}, {"point", at}});
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
                   {"constants", json::object()},      {"joints", json::array()}};
    for (const auto& [name, value] : content.constants) {
        result["constants"][name] = value;
    }
    for (const manifest_joint& joint : content.joints) {
        result["joints"].push_back(joint_json(joint));
    }
    // Only where there are some: few robots have any.
    for (const manifest_loop& loop : content.loops) {
        result["loops"].push_back(loop_json(loop));
    }
    result["effects"] = json::array();
    for (const manifest_effect& effect : content.effects) {
        result["effects"].push_back(effect_json(effect));
    }
    result["operations"] = json::object();
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

manifest_loop read_loop(const json_entry& entry) {
    const std::vector<json_entry> cut = entry.at("cut").items();
    const std::vector<std::string> passive = entry.at("passive").texts();
    if (cut.size() != 2) {
        entry.at("cut").reject("two points");
    }
    if (passive.size() != 2) {
        entry.at("passive").reject("two joints");
    }
    manifest_loop loop;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::vector<std::string> point = cut[side].at("point").texts();
        if (point.size() != 3) {
            cut[side].at("point").reject("three expressions");
        }
        loop.cut[side] = {cut[side].at("link").text(), {point[0], point[1], point[2]}};
        loop.passive[side] = passive[side];
    }
    loop.assembly = entry.at("assembly").text();
    return loop;
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
    if (const auto loops = root.find("loops")) {
        for (const json_entry& loop : loops->items()) {
            result.loops.push_back(read_loop(loop));
        }
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
