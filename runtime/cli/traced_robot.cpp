#include "traced_robot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "description/robot_description.hpp"
#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

constexpr double held_back_share = 1.0 / 3.0;

/// Effects of a description at coordinates of the model: joints are numbered as the torques are.
std::vector<effect_place> declared_effects(const std::string& robot_file, const loaded_robot& robot) {
    const generator::robot_description description = generator::read_robot(robot_file);
    const auto coordinate = [&](int joint) {
        const std::string& name = description.joints[static_cast<std::size_t>(joint)].name;
        for (std::size_t k = 0; k < robot.generated.joints.size(); ++k) {
            if (robot.generated.joints[k].name == name) {
                return static_cast<int>(k);
            }
        }
        return -1;
    };
    std::vector<effect_place> places;
    for (const generator::effect_use& use : description.effects) {
        for (std::size_t k = 0; k < use.joints.size(); ++k) {
            effect_place place{use.effect, {coordinate(use.joints[k])}, {}};
            if (k < use.from.size()) {
                place.from = coordinate(use.from[k]);
            }
            places.push_back(place);
        }
    }
    return places;
}

void check_torque(const std::vector<idim::log>& logs, const std::vector<std::string>& at_rest, std::size_t joints) {
    if (at_rest.size() == joints) {
        throw data_error(logs.front().file + ": no joint moves, nothing can be traced");
    }
}

}  // namespace

std::string joint_name(const loaded_robot& robot, int joint) {
    return robot.generated.joints[static_cast<std::size_t>(joint)].name;
}

trace_input traced_robot::input() const {
    trace_input all;
    all.model = &robot.model();
    all.fitted = fitted;
    all.held_back = held_back;
    all.filter = filter;
    for (const turned_robot& one : turned) {
        all.turned.push_back({one.shape, one.angle, &one.model.interface()});
    }
    all.catalogue = &effects.table();
    all.declared = declared;
    return all;
}

void add_trace_options(CLI::App& command, trace_options& options) {
    command.add_option("robot", options.robot, "robot description (.yaml, .urdf)")->required();
    command.add_option("logs", options.logs, "logs to fit (.csv, .csv.gz)")->required();
    command.add_option("--validation", options.validation,
                       "logs never fitted to; default: the last third of every log is held back");
    add_filter_options(command, options.filter);
    add_json_option(command, options.json_file);
}

traced_robot load_traced_robot(const trace_options& options) {
    loaded_robot robot = load_robot(options.robot);
    const std::vector<idim::log> logs = read_logs(robot, options.logs);
    const std::vector<idim::log> validation = read_logs(robot, options.validation);
    check_torque(logs, joints_at_rest(robot, logs), robot.generated.joints.size());
    const filter_choice filter = choose_filter(logs, options.filter);
    traced_robot traced{std::move(robot), load_effects(options.robot), {}, filter, {}, {}, {}, {}};
    for (const idim::log& data : logs) {
        filtered_samples samples = filter_log(data, filter);
        if (!validation.empty()) {
            traced.fitted.push_back(std::move(samples));
            continue;
        }
        const double gap = 2.0 / filter.band(samples.rate);
        auto [first, last] = hold_back(samples, held_back_share, gap);
        traced.fitted.push_back(std::move(first));
        traced.held_back.push_back(std::move(last));
    }
    for (const idim::log& data : validation) {
        traced.held_back.push_back(filter_log(data, filter));
    }
    if (validation.empty()) {
        traced.held_back_note = "no validation log was given: the last third of every log is held back";
    }
    traced.declared = declared_effects(options.robot, traced.robot);
    const bool is_declared = std::any_of(traced.declared.begin(), traced.declared.end(),
                                         [](const effect_place& place) { return place.effect == "base_tilt"; });
    if (!is_declared) {
        traced.turned = load_turned(options.robot);
    }
    return traced;
}

traced_robot with_description(const traced_robot& before, const std::string& robot_file) {
    traced_robot after{load_robot(robot_file), load_effects(robot_file), {}, before.filter,
                       before.fitted,          before.held_back,         {}, before.held_back_note};
    after.declared = declared_effects(robot_file, after.robot);
    return after;
}

}  // namespace idim::cli
