#include "oracles/mdh_row.hpp"

#include <stdexcept>

namespace idim::test {

namespace {

double value_at(const std::string& text, value_table names, double q) {
    names["q"] = q;
    return text_value(text, names);
}

}  // namespace

mdh_table mdh_table_of(const generator::robot_description& robot) {
    mdh_table table;
    for (const auto& constant : robot.constants) {
        table.constants[constant.name] = text_value(constant.value.text, table.constants);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        table.gravity[i] = text_value(robot.gravity[i].text, table.constants);
    }
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
        const auto& joint = robot.joints[j];
        if (joint.antecedent != static_cast<int>(j) - 1 || joint.type == generator::joint_type::fixed) {
            throw std::runtime_error(robot.name + " is not a serial chain of driven joints");
        }
        mdh_row row;
        row.prismatic = joint.type == generator::joint_type::prismatic;
        row.gamma = text_value(joint.gamma.text, table.constants);
        row.b = text_value(joint.b.text, table.constants);
        row.alpha = text_value(joint.alpha.text, table.constants);
        row.d = text_value(joint.d.text, table.constants);
        row.theta = value_at(joint.theta.text, table.constants, 0.0);
        row.r = value_at(joint.r.text, table.constants, 0.0);
        const std::string& driven = row.prismatic ? joint.r.text : joint.theta.text;
        row.rate = value_at(driven, table.constants, 1.0) - value_at(driven, table.constants, 0.0);
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace idim::test
