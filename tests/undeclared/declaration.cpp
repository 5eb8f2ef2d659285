#include "undeclared/declaration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace idim::undeclared {

namespace {

std::string angle_text(double angle) {
    const double quarters = angle / std::acos(0.0);
    if (quarters == 0.0) {
        return "0";
    }
    return quarters == 1.0 ? "pi/2" : quarters == -1.0 ? "-pi/2" : fmt::format("{}", angle);
}

std::string with_coordinate(double constant, bool moves) {
    if (!moves) {
        return angle_text(constant);
    }
    return constant == 0.0 ? "q" : fmt::format("q {} {}", constant > 0.0 ? "+" : "-", std::abs(constant));
}

/// `name`, or the joints that have it where some do not.
std::string effect_text(const std::string& name, const std::vector<bool>& joints) {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j]) {
            names.push_back(fmt::format("j{}", j + 1));
        }
    }
    if (names.empty()) {
        return "";
    }
    return names.size() == joints.size()
               ? fmt::format("  - {}\n", name)
               : fmt::format("  - {{effect: {}, joints: [{}]}}\n", name, fmt::join(names, ", "));
}

}  // namespace

declaration usual_declaration(const arm& robot, bool offsets) {
    const std::vector<bool> all(robot.rows.size(), true);
    return {all, all, all, std::vector<bool>(robot.rows.size(), offsets)};
}

std::string description_text(const arm& robot, const declaration& declared) {
    std::string text = fmt::format("name: {}\ngravity: [{}, {}, {}]\njoints:\n",
                                   robot.kind[0] >= '0' && robot.kind[0] <= '9' ? "arm_" + robot.kind : robot.kind,
                                   robot.gravity[0], robot.gravity[1], robot.gravity[2]);
    for (std::size_t j = 0; j < robot.rows.size(); ++j) {
        const chain_row& row = robot.rows[j];
        const drive& one = robot.drives[j];
        text += fmt::format(
            "  - {{name: j{}, {}alpha: {}, d: {}, theta: {}, r: {}, limits: {{position: [{:.4f}, {:.4f}], velocity: "
            "{:.4f}}}}}\n",
            j + 1, row.prismatic ? "type: prismatic, " : "", angle_text(row.alpha), row.d,
            with_coordinate(row.theta, !row.prismatic), with_coordinate(row.r, row.prismatic),
            -2.0 * one.position_limit, 2.0 * one.position_limit, 2.0 * one.velocity_limit);
    }
    return text + "effects:\n" + effect_text("rotor_inertia", declared.rotor) +
           effect_text("viscous_friction", declared.viscous) + effect_text("coulomb_friction", declared.coulomb) +
           effect_text("torque_offset", declared.offset);
}

}  // namespace idim::undeclared
