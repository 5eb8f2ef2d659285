#include "emit/urdf_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "description/inertial_parameters.hpp"
#include "description/urdf/xml_element.hpp"

namespace idim::generator {

namespace {

constexpr double unlimited = 1e9;  // of speed and effort, which a URDF must give where there are limits of position

using parameter_values_by_name = std::map<std::string, double>;

std::optional<double> value_of(const parameter_values_by_name& parameters, const std::string& name) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::nullopt : std::optional(found->second);
}

/// The ten of a link, or nothing if one is missing.
std::optional<inertial_parameters> inertia_of(const parameter_values_by_name& parameters, const std::string& label) {
    inertial_parameters values{};
    for (std::size_t k = 0; k < values.size(); ++k) {
        const auto value = value_of(parameters, inertial_names[k] + label);
        if (!value) {
            return std::nullopt;
        }
        values[k] = *value;
    }
    return values;
}

std::string decimal_text(double value) {
    return fmt::format("{}", value + 0.0);  // no negative zero
}

xml_element element(const std::string& name, std::vector<std::pair<std::string, std::string>> attributes,
                    std::vector<xml_element> children = {}) {
    return {name, 0, std::move(attributes), std::move(children)};
}

xml_element origin(const std::array<double, 3>& xyz, const std::array<double, 3>& rpy) {
    const auto three = [](const std::array<double, 3>& v) {
        return decimal_text(v[0]) + " " + decimal_text(v[1]) + " " + decimal_text(v[2]);
    };
    return element("origin", {{"xyz", three(xyz)}, {"rpy", three(rpy)}});
}

xml_element inertial_element(const urdf_inertial& inertial) {
    const auto& I = inertial.inertia;
    return element("inertial", {},
                   {origin(inertial.xyz, inertial.rpy), element("mass", {{"value", decimal_text(inertial.mass)}}),
                    element("inertia", {{"ixx", decimal_text(I[0])},
                                        {"ixy", decimal_text(I[1])},
                                        {"ixz", decimal_text(I[2])},
                                        {"iyy", decimal_text(I[3])},
                                        {"iyz", decimal_text(I[4])},
                                        {"izz", decimal_text(I[5])}})});
}

/// Indented text.
std::string printed(const xml_element& e, int depth = 0) {
    const std::string indent(2 * static_cast<std::size_t>(depth), ' ');
    if (e.children.empty()) {
        return indent + to_string(e) + "\n";
    }
    xml_element head = e;
    head.children.clear();
    std::string text = to_string(head);
    text.replace(text.size() - 2, 2, ">\n");
    for (const xml_element& child : e.children) {
        text += printed(child, depth + 1);
    }
    return indent + text + indent + "</" + e.name + ">\n";
}

/// Puts `child` in the place of the first child of its name, or behind all.
void put(xml_element& parent, xml_element child) {
    const auto same = std::find_if(parent.children.begin(), parent.children.end(),
                                   [&child](const xml_element& c) { return c.name == child.name; });
    if (same == parent.children.end()) {
        parent.children.push_back(std::move(child));
    } else {
        *same = std::move(child);
    }
}

void put_dynamics(xml_element& joint, const parameter_values_by_name& parameters, const std::string& label) {
    xml_element dynamics = element("dynamics", {});
    if (const auto viscous = value_of(parameters, "Fv" + label)) {
        dynamics.attributes.emplace_back("damping", decimal_text(*viscous));
    }
    if (const auto coulomb = value_of(parameters, "Fc" + label)) {
        dynamics.attributes.emplace_back("friction", decimal_text(*coulomb));
    }
    if (!dynamics.attributes.empty()) {
        put(joint, dynamics);
    }
}

/// What of the parameters a URDF has no element for.
std::vector<std::string> left_out(const robot_description& robot, const parameter_values_by_name& parameters) {
    std::string names;
    for (const auto& parameter : parameters) {
        const std::string& name = parameter.first;
        bool is_held = false;
        for (std::size_t j = 0; j < robot.joints.size(); ++j) {
            const std::string label = parameter_label(robot.joints, static_cast<int>(j));
            is_held = is_held || name == "Fv" + label || name == "Fc" + label ||
                      std::any_of(inertial_names.begin(), inertial_names.end(),
                                  [&](const char* kind) { return name == kind + label; });
        }
        if (!is_held && parameter.second != 0.0) {
            names += " " + name;
        }
    }
    return names.empty() ? std::vector<std::string>() : std::vector<std::string>{"a URDF has no place for" + names};
}

/// A number without coordinates: constants at their values, coordinates at zero.
double at_zero(const kinematic_tree& tree, const GiNaC::ex& e) {
    GiNaC::exmap values = values_of_constants(tree);
    for (const GiNaC::symbol& q : tree.q) {
        values[q] = 0;
    }
    return number_of(e, values);
}

double angle(const kinematic_tree& tree, const angle_pair& pair) {
    return std::atan2(at_zero(tree, pair.sin), at_zero(tree, pair.cos));
}

/// Fixed-axis roll, pitch, yaw of R = Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 3> rpy_of(const Eigen::Matrix3d& R) {
    const double cosine = std::hypot(R(0, 0), R(1, 0));
    const double pitch = std::atan2(-R(2, 0), cosine);
    if (cosine < 1e-12) {
        return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0.0};
    }
    return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

/// The frame of a joint's link in that of its antecedent, at q = 0.
xml_element frame_of(const kinematic_tree& tree, const kinematic_joint& joint) {
    const auto turn = [&tree](const angle_pair& pair, const Eigen::Vector3d& axis) {
        return Eigen::AngleAxisd(angle(tree, pair), axis);
    };
    const Eigen::Matrix3d R =
        (turn(joint.gamma, Eigen::Vector3d::UnitZ()) * turn(joint.alpha, Eigen::Vector3d::UnitX()) *
         turn(joint.theta, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    const auto p = joint.position();
    return origin({at_zero(tree, p[0]), at_zero(tree, p[1]), at_zero(tree, p[2])}, rpy_of(R));
}

xml_element joint_element(const robot_description& robot, const kinematic_tree& tree, std::size_t j,
                          const parameter_values_by_name& parameters) {
    const kinematic_joint& joint = tree.joints[j];
    const joint_description& written = robot.joints[j];
    const std::string parent =
        joint.antecedent < 0 ? "base" : tree.joints[static_cast<std::size_t>(joint.antecedent)].name + "_link";
    xml_element result = element("joint", {{"name", joint.name}},
                                 {element("parent", {{"link", parent}}),
                                  element("child", {{"link", joint.name + "_link"}}), frame_of(tree, joint)});
    if (joint.rates.empty()) {
        result.attributes.emplace_back("type", "fixed");
        return result;
    }
    const double rate = at_zero(tree, joint.rates[0].factor);
    if (joint.rates.size() != 1 || joint.rates[0].coordinate != joint.coordinate || std::abs(rate) != 1.0) {
        throw input_error(
            written.where,
            fmt::format("joint {}: moves by more than its own coordinate, which a URDF cannot say", joint.name));
    }
    const bool revolute = joint.type == joint_type::revolute;
    const auto& range = written.limits.position;
    result.attributes.emplace_back("type", !revolute ? "prismatic" : range ? "revolute" : "continuous");
    result.children.push_back(element("axis", {{"xyz", rate > 0.0 ? "0 0 1" : "0 0 -1"}}));
    if (range || !revolute) {
        result.children.push_back(
            element("limit", {{"lower", decimal_text(range ? range->first : -unlimited)},
                              {"upper", decimal_text(range ? range->second : unlimited)},
                              {"effort", decimal_text(written.limits.effort.value_or(unlimited))},
                              {"velocity", decimal_text(written.limits.velocity.value_or(unlimited))}}));
    }
    put_dynamics(result, parameters, joint.label);
    return result;
}

/// The inertial element of a link; nothing where the parameters do not give it.
std::optional<xml_element> inertial_of_link(const parameter_values_by_name& parameters, const std::string& label,
                                            const link_placement& placement, const input_location& where) {
    const auto values = inertia_of(parameters, label);
    if (!values) {
        return std::nullopt;
    }
    try {
        return inertial_element(inertial_of(*values, placement));
    } catch (const std::invalid_argument& error) {
        throw input_error(where, error.what());
    }
}

}  // namespace

urdf_file with_parameters(const std::string& text, const std::string& file, const robot_description& robot,
                          const std::map<std::string, double>& parameters) {
    xml_element root = read_xml(text, file, urdf_limits);
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
        const std::string label = parameter_label(robot.joints, static_cast<int>(j));
        const std::string& link = robot.links[j].link;
        for (xml_element& e : root.children) {
            const std::string* name = e.attribute("name");
            if (e.name == "link" && name != nullptr && *name == link) {
                if (auto inertial = inertial_of_link(parameters, label, robot.links[j], robot.joints[j].where)) {
                    put(e, std::move(*inertial));
                }
            }
            const xml_element* child = e.name == "joint" ? e.child("child") : nullptr;
            if (child != nullptr && child->attribute("link") != nullptr && *child->attribute("link") == link) {
                put_dynamics(e, parameters, label);
            }
        }
    }
    return {"<?xml version=\"1.0\"?>\n" + printed(root), left_out(robot, parameters)};
}

urdf_file to_urdf(const robot_description& robot, const kinematic_tree& tree,
                  const std::map<std::string, double>& parameters) {
    xml_element root = element("robot", {{"name", robot.name}}, {element("link", {{"name", "base"}})});
    link_placement same;
    same.rotation = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        xml_element link = element("link", {{"name", tree.joints[j].name + "_link"}});
        if (auto inertial = inertial_of_link(parameters, tree.joints[j].label, same, robot.joints[j].where)) {
            link.children.push_back(std::move(*inertial));
        }
        root.children.push_back(std::move(link));
        root.children.push_back(joint_element(robot, tree, j, parameters));
    }
    urdf_file result{"<?xml version=\"1.0\"?>\n" + printed(root), left_out(robot, parameters)};
    const std::array<double, 3> g = {at_zero(tree, tree.gravity[0]), at_zero(tree, tree.gravity[1]),
                                     at_zero(tree, tree.gravity[2])};
    if (g[0] != 0.0 || g[1] != 0.0 || g[2] >= 0.0) {
        result.notes.push_back(fmt::format(
            "gravity is {} {} {} in the base frame; programs that read a URDF suppose it along -z", g[0], g[1], g[2]));
    }
    return result;
}

}  // namespace idim::generator
