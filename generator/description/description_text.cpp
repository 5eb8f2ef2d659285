#include <charconv>

#include "description/loop_reader.hpp"
#include "description/robot_description.hpp"

namespace idim::generator {

namespace {

std::string number_text(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

std::string list_text(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) {
        text += (text.empty() ? "" : ", ") + item;
    }
    return "[" + text + "]";
}

std::string list_text(const std::vector<double>& values) {
    std::vector<std::string> items;
    for (const double value : values) {
        items.push_back(number_text(value));
    }
    return list_text(items);
}

std::string names_text(const std::vector<int>& indices, const std::vector<joint_description>& joints) {
    std::vector<std::string> items;
    for (const int index : indices) {
        items.push_back(joints[index].name);
    }
    return list_text(items);
}

std::string joint_text(const joint_description& joint, const std::vector<joint_description>& joints) {
    static constexpr const char* types[] = {"revolute", "prismatic", "fixed"};
    std::string text = "  - {name: " + joint.name + ", type: " + types[static_cast<int>(joint.type)] +
                       ", antecedent: " + link_name(joints, joint.antecedent) + ", gamma: " + joint.gamma.text +
                       ", b: " + joint.b.text + ", alpha: " + joint.alpha.text + ", d: " + joint.d.text +
                       ", theta: " + joint.theta.text + ", r: " + joint.r.text;
    text += joint.massless ? ", massless: true" : "";
    std::string limits;
    const auto add_limit = [&](const std::string& name, const std::string& value) {
        limits += (limits.empty() ? "" : ", ") + name + ": " + value;
    };
    if (joint.limits.position) {
        add_limit("position", list_text({joint.limits.position->first, joint.limits.position->second}));
    }
    if (joint.limits.velocity) {
        add_limit("velocity", number_text(*joint.limits.velocity));
    }
    if (joint.limits.effort) {
        add_limit("effort", number_text(*joint.limits.effort));
    }
    text += limits.empty() ? "" : ", limits: {" + limits + "}";
    text += joint.drive_gain ? ", drive_gain: " + number_text(*joint.drive_gain) : "";
    return text + "}\n";
}

std::string effect_text(const effect_use& use, const std::vector<joint_description>& joints) {
    std::string text = "  - {effect: " + use.effect + ", joints: " + names_text(use.joints, joints);
    text += use.from.empty() ? "" : ", from: " + names_text(use.from, joints);
    std::string shape;
    for (const auto& [name, value] : use.shape) {
        shape += (shape.empty() ? "" : ", ") + name + ": " + number_text(value);
    }
    return text + (shape.empty() ? "" : ", shape: {" + shape + "}") + "}\n";
}

std::string control_text(const control_description& control) {
    std::string text = "control: {law: " + control.law + ", rate: " + number_text(control.rate) +
                       ", delay: " + number_text(control.delay);
    for (const auto& [name, values] : control.values) {
        text += ", " + name + ": " + list_text(values);
    }
    return text + "}\n";
}

}  // namespace

std::string to_string(const robot_description& robot) {
    std::vector<std::string> gravity;
    for (const expression_text& entry : robot.gravity) {
        gravity.push_back(entry.text);
    }
    std::string text = "name: " + robot.name + "\ngravity: " + list_text(gravity) + "\n";
    text += robot.constants.empty() ? "" : "constants:\n";
    for (const constant_description& constant : robot.constants) {
        text += "  " + constant.name + ": " + constant.value.text + "\n";
    }
    text += "joints:\n";
    for (const joint_description& joint : robot.joints) {
        text += joint_text(joint, robot.joints);
    }
    text += robot.loops.empty() ? "" : "loops:\n";
    for (const loop_description& loop : robot.loops) {
        text += "  - " + to_string(loop, robot.joints) + "\n";
    }
    text += robot.effects.empty() ? "" : "effects:\n";
    for (const effect_use& use : robot.effects) {
        text += effect_text(use, robot.joints);
    }
    text += robot.control ? control_text(*robot.control) : "";
    text += robot.parameters.empty() ? "" : "parameters:\n";
    for (const auto& [name, value] : robot.parameters) {
        text += "  " + name + ": " + number_text(value) + "\n";
    }
    return text;
}

}  // namespace idim::generator
