#include "description/robot_description.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "description/control_reader.hpp"
#include "description/effect_reader.hpp"
#include "description/identifier.hpp"
#include "description/joint_reader.hpp"
#include "description/loop_reader.hpp"
#include "description/urdf/urdf_robot.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

std::vector<expression_text> default_gravity(const input_location& where) {
    return {{"0", where}, {"0", where}, {"-9.81", where}};
}

std::vector<expression_text> read_gravity(const yaml_fields& robot) {
    std::vector<expression_text> gravity;
    if (const auto written = robot.find("gravity")) {
        for (const yaml_value& entry : written->items("three entries [m/s^2] such as [0, 0, -9.81]")) {
            gravity.push_back({entry.expression(), entry.where()});
        }
        if (gravity.size() != 3) {
            throw input_error(written->where(), "expected three entries [m/s^2] such as [0, 0, -9.81], got " +
                                                    std::to_string(gravity.size()));
        }
        return gravity;
    }
    return default_gravity(in_field(robot.where(), "gravity"));
}

std::vector<constant_description> read_constants(const yaml_fields& robot) {
    std::vector<constant_description> constants;
    if (const auto written = robot.find("constants")) {
        for (const auto& [name, value] : written->entries("a map of names to numbers or expressions")) {
            constants.push_back({checked_symbol(name, value.where()), {value.expression(), value.where()}});
        }
    }
    return constants;
}

std::map<std::string, double> read_parameters(const yaml_fields& robot) {
    std::map<std::string, double> parameters;
    if (const auto written = robot.find("parameters")) {
        for (const auto& [name, value] : written->entries("a map of parameters to numbers")) {
            parameters[checked_name(name, value.where())] = value.number();
        }
    }
    return parameters;
}

/// Path of the URDF file that a YAML file names, from the folder of the YAML file.
std::string named_urdf(const yaml_fields& robot, const yaml_value& written) {
    if (const auto joints = robot.find("joints")) {
        throw input_error(joints->where(), "the URDF gives the joints, expected one of joints and urdf");
    }
    const std::filesystem::path folder = std::filesystem::path(robot.where().file).parent_path();
    return (folder / written.text("a file such as arm.urdf")).string();
}

/// Takes over what the URDF gives; effects are known by now.
void add_urdf(const urdf_robot& urdf, robot_description& robot) {
    robot.links = urdf.links;
    robot.notes = urdf.notes;
    robot.parameters.insert(urdf.inertial.begin(), urdf.inertial.end());
    for (const effect_use& use : robot.effects) {
        for (const int joint : use.joints) {
            const std::string label = parameter_label(robot.joints, joint);
            if (use.effect == "viscous_friction" && urdf.damping.count(joint) != 0) {
                robot.parameters.emplace("Fv" + label, urdf.damping.at(joint));
            } else if (use.effect == "coulomb_friction" && urdf.friction.count(joint) != 0) {
                robot.parameters.emplace("Fc" + label, urdf.friction.at(joint));
            }
        }
    }
}

robot_description bare_urdf(const std::string& file) {
    const urdf_robot urdf = read_urdf_robot(file);
    robot_description robot;
    robot.urdf_file = file;
    robot.name = urdf.name;
    robot.gravity = default_gravity({file, 0, "gravity"});
    robot.joints = urdf.joints;
    for (const char* effect : {"rotor_inertia", "viscous_friction", "coulomb_friction"}) {
        if (!urdf.actuated.empty()) {
            robot.effects.push_back({effect, urdf.actuated, {}, {}, {file, 0, "effects"}});
        }
    }
    add_urdf(urdf, robot);
    return robot;
}

robot_description read_yaml_robot(const std::string& file) {
    const yaml_value root = read_yaml(file);
    const yaml_fields fields(
        root, {"name", "gravity", "constants", "joints", "loops", "effects", "control", "parameters", "urdf"});
    robot_description robot;
    const auto urdf_file = fields.find("urdf");
    const auto name = urdf_file ? fields.find("name") : fields.require("name", "the name of the robot");
    robot.name = name ? checked_name(name->text("the name of the robot"), name->where()) : "";
    robot.gravity = read_gravity(fields);
    robot.constants = read_constants(fields);
    std::optional<urdf_robot> urdf;
    ordered_joints ordered;
    if (urdf_file) {
        robot.urdf_file = named_urdf(fields, *urdf_file);
        urdf = read_urdf_robot(robot.urdf_file);
        ordered = {urdf->joints, urdf->written_row};
        robot.name = name ? robot.name : urdf->name;
    } else {
        ordered = read_joints(fields.require("joints", "a list of joints"));
    }
    if (const auto loops = fields.find("loops")) {
        robot.loops = read_loops(*loops, ordered.joints);
    }
    robot.joints = ordered.joints;
    robot.effects = read_effects(fields, robot.joints);
    robot.control = read_control(fields, ordered);
    robot.parameters = read_parameters(fields);
    if (urdf) {
        add_urdf(*urdf, robot);
    }
    return robot;
}

}  // namespace

bool is_header(const control_description& control) {
    return control.law.ends_with(header_ending);
}

bool has_own_coordinate(const joint_description& joint) {
    if (joint.type == joint_type::fixed || joint.passive) {
        return false;
    }
    const std::string& text = joint.type == joint_type::revolute ? joint.theta.text : joint.r.text;
    const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = text.find('q'); at != std::string::npos; at = text.find('q', at + 1)) {
        const bool starts = at == 0 || !is_letter(text[at - 1]);
        const bool ends = at + 1 == text.size() || !is_letter(text[at + 1]);
        if (starts && ends) {
            return true;
        }
    }
    return false;
}

std::vector<int> driven_joints(const std::vector<joint_description>& joints) {
    std::vector<int> driven;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (has_own_coordinate(joints[j])) {
            driven.push_back(static_cast<int>(j));
        }
    }
    return driven;
}

std::string link_name(const std::vector<joint_description>& joints, int link) {
    return link < 0 ? "base" : joints[static_cast<std::size_t>(link)].name;
}

std::string parameter_label(const std::vector<joint_description>& joints, int joint) {
    if (!has_own_coordinate(joints[joint])) {
        return "_" + joints[joint].name;
    }
    return std::to_string(1 + std::count_if(joints.begin(), joints.begin() + joint, has_own_coordinate));
}

robot_description read_robot(const std::string& file) {
    const bool is_urdf = std::filesystem::path(file).extension() == ".urdf";
    robot_description robot = is_urdf ? bare_urdf(file) : read_yaml_robot(file);
    robot.file = file;
    return robot;
}

}  // namespace idim::generator
