#include "excitation_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "description/robot_description.hpp"
#include "identified_parameters.hpp"
#include "idim/input_error.hpp"
#include "idim/recorded_states.hpp"
#include "kinematics/kinematic_tree.hpp"
#include "option_text.hpp"
#include "workspace_file.hpp"

namespace idim::cli {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<std::string> joint_names(const idim_model_interface& model) {
    return {model.joint_names, model.joint_names + model.dof};
}

void set_positive(const std::string& option, const std::vector<std::string>& texts, const idim_model_interface& model,
                  Eigen::VectorXd& limit) {
    for (const std::string& text : texts) {
        const addressed target = address(option, text, joint_names(model));
        const std::string expected = "VALUE or JOINT=VALUE, a positive number";
        const std::optional<double> value = finite_number(target.text);
        if (!value || !(*value > 0.0)) {
            refuse_option(option, text, expected);
        }
        for (const std::size_t j : target.places) {
            limit[static_cast<Eigen::Index>(j)] = *value;
        }
    }
}

void set_positions(const std::vector<std::string>& texts, const idim_model_interface& model, motion_limits& limits) {
    const std::string option = "--position";
    for (const std::string& text : texts) {
        const addressed target = address(option, text, joint_names(model));
        const std::string expected = "LOW:HIGH or JOINT=LOW:HIGH, two numbers, the lower first";
        const std::size_t colon = std::min(target.text.find(':'), target.text.size());
        const std::optional<double> low = finite_number(target.text.substr(0, colon));
        const std::optional<double> high = finite_number(target.text.substr(std::min(colon + 1, target.text.size())));
        if (!low || !high || !(*low < *high)) {
            refuse_option(option, text, expected);
        }
        for (const std::size_t j : target.places) {
            limits.lower[static_cast<Eigen::Index>(j)] = *low;
            limits.upper[static_cast<Eigen::Index>(j)] = *high;
        }
    }
}

/// Limits of the description; positions NaN and all else infinite where it has none.
motion_limits declared_limits(const generator::robot_description& description, const std::vector<int>& driven) {
    const auto n = static_cast<Eigen::Index>(driven.size());
    motion_limits limits{Eigen::VectorXd::Constant(n, NAN),      Eigen::VectorXd::Constant(n, NAN),
                         Eigen::VectorXd::Constant(n, infinite), Eigen::VectorXd::Constant(n, infinite),
                         Eigen::VectorXd::Constant(n, infinite), {}};
    for (Eigen::Index j = 0; j < n; ++j) {
        const generator::joint_limits& own =
            description.joints[static_cast<std::size_t>(driven[static_cast<std::size_t>(j)])].limits;
        if (own.position) {
            limits.lower[j] = own.position->first;
            limits.upper[j] = own.position->second;
        }
        limits.velocity[j] = own.velocity.value_or(infinite);
        limits.torque[j] = own.effort.value_or(infinite);
    }
    return limits;
}

void require_room(const motion_limits& limits, const generator::robot_description& description,
                  const std::vector<int>& driven) {
    for (Eigen::Index j = 0; j < limits.lower.size(); ++j) {
        const auto& joint = description.joints[static_cast<std::size_t>(driven[static_cast<std::size_t>(j)])];
        const auto check = [&](bool good, const std::string& field, const std::string& what,
                               const std::string& expected) {
            if (!good) {
                throw input_error({description.file, joint.where.line, "limits." + field},
                                  fmt::format("{} for joint {}, expected {} here or --{} {}={}", what, joint.name,
                                              expected, field, joint.name, field == "position" ? "LOW:HIGH" : "VALUE"));
            }
        };
        check(!std::isnan(limits.lower[j]), "position", "missing", "two numbers");
        check(limits.lower[j] < limits.upper[j], "position", "no room", "the lower number first");
        check(std::isfinite(limits.velocity[j]), "velocity", "missing", "a number");
        check(limits.velocity[j] > 0.0, "velocity", "no room", "a positive number");
        check(limits.torque[j] > 0.0, "effort", "no room", "a positive number");
    }
}

void require_plain_model(const idim_model_interface& model, const generator::kinematic_tree& tree,
                         const std::string& file) {
    if (model.n_states > 0 || has_soft_joint(model) || model.needs_rigid_torque != 0) {
        throw input_error({file, 0, "effects"},
                          "their regressor depends on more than the motion of the joints, expected none with states, "
                          "elasticity or friction by load: excite the robot without them");
    }
    if (!tree.closures.empty()) {
        throw input_error({file, 0, "loops"}, "not planned for, expected no closed loops but parallelograms");
    }
}

/// Base parameters of --parameters, or of the a-priori parameters; empty where neither is there.
Eigen::VectorXd known_parameters(const loaded_robot& robot, const generator::robot_description& description,
                                 const std::string& file) {
    if (!file.empty()) {
        return read_parameters(file, robot).chi;
    }
    if (description.parameters.empty()) {
        return {};
    }
    const idim_model_interface& model = robot.model();
    Eigen::VectorXd standard = Eigen::VectorXd::Zero(model.n_standard);
    int missing = 0;
    for (int k = 0; k < model.n_standard; ++k) {
        const auto found = description.parameters.find(model.standard_names[k]);
        missing += found == description.parameters.end() ? 1 : 0;
        standard[k] = found == description.parameters.end() ? 0.0 : found->second;
    }
    if (missing > 0) {
        print_notes(description.file, {fmt::format("torques by its a-priori parameters; {} of {} have no value and "
                                                   "count as 0",
                                                   missing, model.n_standard)});
    }
    Eigen::VectorXd chi(model.n_base);
    model.regroup(standard.data(), chi.data());
    return chi;
}

}  // namespace

void add_limit_options(CLI::App& command, limit_options& options) {
    command
        .add_option("--position", options.position,
                    "may be repeated: LOW:HIGH [rad or m] for every joint, JOINT=LOW:HIGH for one, in the place of the "
                    "description's limits")
        ->allow_extra_args(false);
    command.add_option("--velocity", options.velocity, "likewise VALUE or JOINT=VALUE [rad/s or m/s]")
        ->allow_extra_args(false);
    command.add_option("--acceleration", options.acceleration, "likewise [rad/s^2 or m/s^2]; default: no limit")
        ->allow_extra_args(false);
    command.add_option("--torque", options.torque, "likewise [N*m or N]; kept where parameters are known")
        ->allow_extra_args(false);
    command.add_option("--workspace", options.workspace,
                       "YAML list of boxes that points of links stay in: {link: j6, point: [0, 0, 0.1], box: [[-0.5, "
                       "0.5], [-0.5, 0.5], [0.1, 1]]}, points in the frame of the link, boxes in that of the base [m]");
    command.add_option("--parameters", options.parameters,
                       "result of identify --json, or a map of base parameters to values: for torques");
}

limited_robot limited(const loaded_robot& robot, const std::string& robot_file, const limit_options& options) {
    const generator::robot_description description = generator::read_robot(robot_file);
    const generator::kinematic_tree tree = generator::build_kinematic_tree(description);
    const idim_model_interface& model = robot.model();
    require_plain_model(model, tree, description.file);
    motion_limits limits = declared_limits(description, tree.driven);
    set_positions(options.position, model, limits);
    set_positive("--velocity", options.velocity, model, limits.velocity);
    set_positive("--acceleration", options.acceleration, model, limits.acceleration);
    set_positive("--torque", options.torque, model, limits.torque);
    require_room(limits, description, tree.driven);
    limited_robot result{model, limits, known_parameters(robot, description, options.parameters), {}};
    if (result.chi.size() == 0 && !options.torque.empty()) {
        throw input_error({"", 0, "--torque"}, "needs parameters, expected --parameters FILE");
    }
    if (!options.workspace.empty()) {
        result.links = link_rows(tree);
        result.limits.boxes = read_workspace(options.workspace, tree);
    }
    return result;
}

}  // namespace idim::cli
