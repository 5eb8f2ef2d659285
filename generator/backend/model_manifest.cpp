#include "backend/model_manifest.hpp"

#include "description/loop_reader.hpp"

namespace idim::generator {

namespace {

const char* to_string(joint_type type) {
    switch (type) {
        case joint_type::revolute:
            return "revolute";
        case joint_type::prismatic:
            return "prismatic";
        case joint_type::fixed:
            break;
    }
    return "fixed";
}

manifest_joint describe(const joint_description& joint, bool is_driven, const robot_description& robot) {
    manifest_joint result;
    result.name = joint.name;
    result.type = to_string(joint.type);
    result.antecedent = link_name(robot.joints, joint.antecedent);
    result.driven = is_driven;
    result.position = joint.limits.position;
    result.velocity = joint.limits.velocity;
    result.effort = joint.limits.effort;
    result.drive_gain = joint.drive_gain;
    const std::pair<const char*, const expression_text*> row[] = {{"gamma", &joint.gamma}, {"b", &joint.b},
                                                                  {"alpha", &joint.alpha}, {"d", &joint.d},
                                                                  {"theta", &joint.theta}, {"r", &joint.r}};
    for (const auto& [name, entry] : row) {
        if (entry->text != "0") {
            result.row.emplace_back(name, entry->text);
        }
    }
    return result;
}

manifest_loop describe(const loop_description& loop, const robot_description& robot) {
    manifest_loop result;
    for (std::size_t side = 0; side < 2; ++side) {
        const link_point& from = loop.cut[side];
        result.cut[side] = {link_name(robot.joints, from.link),
                            {from.point[0].text, from.point[1].text, from.point[2].text}};
        result.passive[side] = link_name(robot.joints, loop.passive[side]);
    }
    result.assembly = to_string(loop.assembly);
    return result;
}

manifest_effect describe(const effect_use& use, const effect_description& effect, const robot_description& robot) {
    manifest_effect result{use.effect, {}, {}, {use.shape.begin(), use.shape.end()}, law_of(effect)};
    const auto add_names = [&robot](const std::vector<int>& joints, std::vector<std::string>& names) {
        for (const int j : joints) {
            names.push_back(link_name(robot.joints, j));
        }
    };
    add_names(use.joints, result.joints);
    add_names(use.from, result.from);
    return result;
}

}  // namespace

manifest describe(const robot_model& model, const template_context& context) {
    manifest result;
    result.generator = "idim " + context.version;
    result.robot = context.robot;
    result.input_hash = context.input_hash;
    result.cost = context.cost;
    for (const expression_text& entry : model.description.gravity) {
        result.gravity.push_back(entry.text);
    }
    result.constants = named_constants(model);
    for (std::size_t j = 0; j < model.description.joints.size(); ++j) {
        const bool is_driven = model.tree.joints[j].coordinate >= 0;
        result.joints.push_back(describe(model.description.joints[j], is_driven, model.description));
    }
    for (const loop_description& loop : model.description.loops) {
        result.loops.push_back(describe(loop, model.description));
    }
    for (std::size_t i = 0; i < model.effects.size(); ++i) {
        result.effects.push_back(describe(model.description.effects[i], model.effects[i], model.description));
    }
    for (const function_context& function : context.functions) {
        result.operations.emplace_back(function.name, function.operations);
    }
    return result;
}

}  // namespace idim::generator
