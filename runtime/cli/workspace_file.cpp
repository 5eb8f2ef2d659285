#include "workspace_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

double angle_of(const generator::angle_pair& angle, const GiNaC::exmap& values) {
    return std::atan2(generator::number_of(angle.sin, values), generator::number_of(angle.cos, values));
}

input_location place(const std::string& file, const YAML::Node& node, const std::string& field) {
    return {file, node.Mark().line + 1, field};
}

std::vector<double> numbers(const YAML::Node& node, std::size_t count, const input_location& where,
                            const std::string& expected) {
    std::vector<double> values;
    for (std::size_t i = 0; node.IsSequence() && i < node.size(); ++i) {
        double value = NAN;
        if (YAML::convert<double>::decode(node[i], value) && std::isfinite(value)) {
            values.push_back(value);
        }
    }
    if (values.size() != count || node.size() != count) {
        throw input_error(where, "expected " + expected);
    }
    return values;
}

int link_of(const YAML::Node& entry, const std::string& file, const generator::kinematic_tree& tree) {
    std::vector<std::string> names;
    const YAML::Node node = entry["link"];
    for (const generator::kinematic_joint& joint : tree.joints) {
        if (node && node.IsScalar() && node.Scalar() == joint.name) {
            return static_cast<int>(names.size());
        }
        names.push_back(joint.name);
    }
    throw input_error(place(file, node ? node : entry, "link"),
                      fmt::format("expected one of: {}", fmt::join(names, ", ")));
}

workspace_box box_of(const YAML::Node& entry, const std::string& file, const generator::kinematic_tree& tree) {
    if (!entry.IsMap()) {
        throw input_error(place(file, entry, ""), "expected {link, point, box}");
    }
    for (const auto& field : entry) {
        const auto name = field.first.as<std::string>();
        if (name != "link" && name != "point" && name != "box") {
            throw input_error(place(file, field.first, name), "unknown, expected link, point and box");
        }
    }
    workspace_box box;
    box.link = link_of(entry, file, tree);
    box.point.setZero();
    if (const YAML::Node point = entry["point"]) {
        box.point = Eigen::Map<const Eigen::Vector3d>(
            numbers(point, 3, place(file, point, "point"), "three numbers [m]").data());
    }
    const YAML::Node sides = entry["box"];
    const std::string expected = "[[low, high] of x, of y, of z], finite numbers [m], the lower first";
    if (!sides || !sides.IsSequence() || sides.size() != 3) {
        throw input_error(place(file, sides ? sides : entry, "box"), "expected " + expected);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const YAML::Node side = sides[static_cast<std::size_t>(axis)];
        const std::vector<double> ends = numbers(side, 2, place(file, side, "box"), expected);
        if (!(ends[0] < ends[1])) {
            throw input_error(place(file, side, "box"), "expected " + expected);
        }
        box.low[axis] = ends[0];
        box.high[axis] = ends[1];
    }
    box.name = fmt::format("{}:{}: box of {}", file, entry.Mark().line + 1,
                           tree.joints[static_cast<std::size_t>(box.link)].name);
    return box;
}

}  // namespace

std::vector<link_row> link_rows(const generator::kinematic_tree& tree) {
    GiNaC::exmap values = generator::values_of_constants(tree);
    for (const GiNaC::symbol& q : tree.q) {
        values[q] = 0;
    }
    const auto number = [&](const GiNaC::ex& expression) { return generator::number_of(expression, values); };
    std::vector<link_row> rows;
    for (const generator::kinematic_joint& joint : tree.joints) {
        link_row row;
        row.parent = joint.antecedent;
        row.gamma = angle_of(joint.gamma, values);
        row.b = number(joint.b);
        row.alpha = angle_of(joint.alpha, values);
        row.d = number(joint.d);
        row.r = number(joint.r);
        row.prismatic = joint.type == generator::joint_type::prismatic;
        const bool turns = joint.type == generator::joint_type::revolute && !joint.rates.empty();
        row.theta = turns ? number(joint.variable) : angle_of(joint.theta, values);
        row.rate = Eigen::VectorXd::Zero(tree.dof());
        for (const generator::joint_rate& rate : joint.rates) {
            row.rate[rate.coordinate] = number(rate.factor);
        }
        rows.push_back(row);
    }
    return rows;
}

std::vector<workspace_box> read_workspace(const std::string& file, const generator::kinematic_tree& tree) {
    YAML::Node root;
    try {
        root = YAML::LoadFile(file);
    } catch (const YAML::BadFile&) {
        throw input_error({file, 0, ""}, "cannot be read");
    } catch (const YAML::ParserException& error) {
        throw input_error({file, error.mark.line + 1, ""}, "malformed: " + error.msg);
    }
    if (!root.IsSequence() || root.size() == 0) {
        throw input_error({file, 1, ""}, "expected a list of {link, point, box}");
    }
    std::vector<workspace_box> boxes;
    for (const YAML::Node& entry : root) {
        boxes.push_back(box_of(entry, file, tree));
    }
    return boxes;
}

}  // namespace idim::cli
