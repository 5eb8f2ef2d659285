#include "refined_description.hpp"

#include <algorithm>
#include <filesystem>

#include "description/effect_insertion.hpp"
#include "description/robot_description.hpp"
#include "description/text_file.hpp"
#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_description = 10'000'000;

bool is_urdf(const std::string& file) {
    return fs::path(file).extension() == ".urdf";
}

/// The description that a bare URDF stands for.
std::string description_of_urdf(const std::string& file) {
    const generator::robot_description robot = generator::read_robot(file);
    std::string text = "name: " + robot.name + "\nurdf: " + fs::path(file).filename().string() + "\neffects:\n";
    for (const generator::effect_use& use : robot.effects) {
        generator::effect_item item{use.effect, {}, {}, use.shape};
        for (const int j : use.joints) {
            item.joints.push_back(robot.joints[static_cast<std::size_t>(j)].name);
        }
        text += "  - " + to_yaml(item) + "\n";
    }
    return text;
}

/// Whether the effect is the whole robot's: no joints are written for it.
bool is_of_the_robot(const std::string& effect, const idim_effect_table& catalogue) {
    return std::any_of(catalogue.effects, catalogue.effects + catalogue.count, [&](const idim_effect& entry) {
        return entry.name == effect && entry.scope == IDIM_EFFECT_ROBOT;
    });
}

generator::effect_item item_of(const trace_step& step, const traced_robot& traced) {
    const loaded_robot& robot = traced.robot;
    generator::effect_item item{step.place.effect, {}, {}, {}};
    if (!is_of_the_robot(step.place.effect, traced.effects.table())) {
        item.joints.push_back(joint_name(robot, step.place.joints.front()));
        if (step.place.joints.size() == 2) {
            item.from.push_back(joint_name(robot, step.place.joints[1]));
        } else if (step.place.from) {
            item.from.push_back(joint_name(robot, *step.place.from));
        }
    }
    for (const effect_parameter& parameter : step.parameters) {
        if (parameter.is_shape) {
            item.shape[parameter.name] = parameter.value;
        }
    }
    return item;
}

void copy_beside(const fs::path& from, const fs::path& folder) {
    std::error_code problem;
    fs::copy_file(from, folder / from.filename(), fs::copy_options::overwrite_existing, problem);
    if (problem) {
        throw input_error({(folder / from.filename()).string(), 0, ""}, "cannot be written: " + problem.message());
    }
}

/// Effects of the robot's own, its control law and the URDF stand where the description looks for them.
void copy_what_it_names(const std::string& robot_file, const fs::path& folder) {
    const fs::path beside = fs::path(robot_file).has_parent_path() ? fs::path(robot_file).parent_path() : fs::path(".");
    if (fs::equivalent(beside, folder)) {
        return;
    }
    const generator::robot_description robot = generator::read_robot(robot_file);
    if (robot.control && generator::is_header(*robot.control) && fs::exists(beside / robot.control->law)) {
        copy_beside(beside / robot.control->law, folder);
    }
    for (const generator::effect_use& use : robot.effects) {
        for (const fs::path& own : {beside / (use.effect + ".yaml"), beside / "effects" / (use.effect + ".yaml")}) {
            if (fs::exists(own)) {
                copy_beside(own, folder);
                break;
            }
        }
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(beside)) {
        if (is_urdf(entry.path().string())) {
            copy_beside(entry.path(), folder);
        }
    }
}

}  // namespace

std::string write_with_effects(const std::string& robot_file, const std::vector<generator::effect_item>& items,
                               const std::string& folder) {
    const std::string before = is_urdf(robot_file) ? description_of_urdf(robot_file)
                                                   : generator::read_text_file(robot_file, largest_description);
    const std::string text = generator::with_effects(before, items, robot_file);
    copy_what_it_names(robot_file, folder);
    const fs::path path = fs::path(folder) / "robot.yaml";
    write_text(path, text);
    return path.string();
}

std::string write_refined_description(const std::string& robot_file, const traced_robot& traced,
                                      const std::vector<trace_step>& steps, const std::string& folder) {
    std::vector<generator::effect_item> items;
    for (const trace_step& step : steps) {
        items.push_back(item_of(step, traced));
    }
    return write_with_effects(robot_file, items, folder);
}

}  // namespace idim::cli
