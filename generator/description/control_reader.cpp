#include "description/control_reader.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "description/identifier.hpp"

namespace idim::generator {

namespace {

/// One number per driven joint in the order of the model; `written` holds one for all, or a list in the order of the
/// file.
std::vector<double> read_per_joint(const yaml_value& written, const ordered_joints& ordered) {
    const std::vector<int> driven = driven_joints(ordered.joints);
    if (written.is_scalar()) {
        return std::vector<double>(driven.size(), written.number());
    }
    const auto items = written.items("a number or a list of numbers");
    if (items.size() != driven.size()) {
        throw input_error(written.where(), "expected one number or a list of " + std::to_string(driven.size()) +
                                               ", one for each joint that moves, got " + std::to_string(items.size()));
    }
    std::vector<int> rows;
    for (const int joint : driven) {
        rows.push_back(ordered.written_row[joint]);
    }
    std::vector<double> values;
    for (const int row : rows) {
        const auto rank = std::count_if(rows.begin(), rows.end(), [&](int other) { return other < row; });
        values.push_back(items[static_cast<std::size_t>(rank)].number());
    }
    return values;
}

/// A name, or one with .hpp: a header beside the description.
std::string read_law(const yaml_value& value) {
    const std::string law = value.text("the name of a control law, or of a header such as my_law.hpp");
    checked_name(law.ends_with(header_ending) ? law.substr(0, law.size() - header_ending.size()) : law, value.where());
    return law;
}

}  // namespace

std::optional<control_description> read_control(const yaml_fields& robot, const ordered_joints& ordered) {
    const auto written = robot.find("control");
    if (!written) {
        return std::nullopt;
    }
    control_description control;
    control.where = written->where();
    for (const auto& [key, value] : written->entries("a map such as {law: pd_cascade, rate: 200, kp: 10, kv: 1}")) {
        if (key == "law") {
            control.law = read_law(value);
        } else if (key == "rate") {
            control.rate = value.positive_number();
        } else if (key == "delay") {
            control.delay = value.number();
            if (control.delay < 0.0) {
                value.reject("a number of seconds, zero or more");
            }
        } else {
            control.values[checked_name(key, value.where())] = read_per_joint(value, ordered);
        }
    }
    if (control.law.empty()) {
        throw input_error(in_field(control.where, "law"), "missing, expected the name of a control law");
    }
    return control;
}

}  // namespace idim::generator
