#include "description/effect_reader.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "description/identifier.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t most_effects = 1000;

std::vector<int> read_joint_names(const yaml_value& written, const std::vector<joint_description>& joints) {
    const auto items = written.items("a list of joint names such as [" + joints.front().name + "]");
    if (items.empty() || items.size() > most_joints) {
        throw input_error(written.where(), "expected between 1 and " + std::to_string(most_joints) +
                                               " joint names, got " + std::to_string(items.size()));
    }
    std::vector<int> indices;
    for (const yaml_value& item : items) {
        const std::string name = item.text("a joint name");
        const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& j) { return j.name == name; });
        if (found == joints.end()) {
            item.reject("the name of a joint of this robot");
        }
        if (found->type == joint_type::fixed) {
            throw input_error(item.where(), "joint " + quote(name) + " is fixed, expected one that moves");
        }
        indices.push_back(static_cast<int>(found - joints.begin()));
    }
    return indices;
}

void read_from(const yaml_value& written, const std::vector<joint_description>& joints, effect_use& use) {
    use.from = read_joint_names(written, joints);
    if (use.from.size() != use.joints.size()) {
        throw input_error(written.where(), "expected " + std::to_string(use.joints.size()) +
                                               " joint names, one for each of `joints`, got " +
                                               std::to_string(use.from.size()));
    }
    for (std::size_t k = 0; k < use.from.size(); ++k) {
        if (use.from[k] == use.joints[k]) {
            throw input_error(written.where(), "joint " + quote(joints[use.from[k]].name) +
                                                   " is driven by itself, expected another joint");
        }
    }
}

effect_use read_effect_use(const yaml_value& written, const std::vector<joint_description>& joints) {
    effect_use use;
    use.where = written.where();
    use.joints = driven_joints(joints);
    if (written.is_scalar()) {
        use.effect = checked_name(written.text("an effect"), written.where());
        return use;
    }
    if (!written.is_map()) {
        written.reject("the name of an effect or a map {effect, joints, from, shape}");
    }
    const yaml_fields fields(written, {"effect", "joints", "from", "shape"});
    const yaml_value name = fields.require("effect", "the name of an effect");
    use.effect = checked_name(name.text("the name of an effect"), name.where());
    if (const auto names = fields.find("joints")) {
        use.joints = read_joint_names(*names, joints);
    }
    if (const auto from = fields.find("from")) {
        read_from(*from, joints, use);
    }
    if (const auto shape = fields.find("shape")) {
        for (const auto& [key, value] : shape->entries("a map of shape coefficients to numbers")) {
            use.shape[checked_symbol(key, value.where())] = value.number();
        }
    }
    return use;
}

}  // namespace

std::vector<effect_use> read_effects(const yaml_fields& robot, const std::vector<joint_description>& joints) {
    std::vector<effect_use> effects;
    const auto written = robot.find("effects");
    if (!written) {
        return effects;
    }
    std::map<std::tuple<std::string, int, int>, int> lines;  // effect, joint, from joint
    const auto items = written->items("a list of effects such as [viscous_friction]");
    if (items.size() > most_effects) {
        throw input_error(written->where(), "expected at most " + std::to_string(most_effects) + " effects, got " +
                                                std::to_string(items.size()));
    }
    for (const yaml_value& item : items) {
        effects.push_back(read_effect_use(item, joints));
        const effect_use& use = effects.back();
        for (std::size_t k = 0; k < use.joints.size(); ++k) {
            const int from = use.from.empty() ? base_link : use.from[k];
            const auto [first, is_new] = lines.emplace(std::tuple(use.effect, use.joints[k], from), use.where.line);
            if (!is_new) {
                throw input_error(use.where, "effect " + quote(use.effect) + " is already on joint " +
                                                 quote(joints[use.joints[k]].name) + ", line " +
                                                 std::to_string(first->second));
            }
        }
    }
    return effects;
}

}  // namespace idim::generator
