#include "generator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "backend/model_context.hpp"
#include "emit/content_hash.hpp"

namespace idim::generator {

namespace {

robot_model load(const std::string& robot_file, const std::string& templates, bool rigid = false) {
    robot_model model;
    model.description = read_robot(robot_file);
    if (rigid) {
        model.description.effects.clear();
    }
    for (const effect_use& use : model.description.effects) {
        model.effects.push_back(find_effect(use, model.description, templates + "/effects"));
    }
    model.tree = build_kinematic_tree(model.description);
    if (model.tree.dof() == 0) {
        throw input_error({robot_file, 0, "joints"}, "expected at least one revolute or prismatic joint");
    }
    model.parameters = list_parameters(model.tree, model.description.effects, model.effects);
    model.base = find_base_parameters(model.tree, model.parameters);
    return model;
}

base_report report(const robot_model& model) {
    base_report result;
    result.robot = model.description.name;
    result.notes = model.description.notes;
    for (const base_parameter& base : model.base.parameters) {
        result.parameters.push_back({base.name, base.unit, base.formula});
    }
    for (const std::size_t p : model.base.without_effect) {
        result.without_effect.push_back(model.parameters.all[p].name);
    }
    const rank_evidence& evidence = model.base.evidence;
    result.standard = model.base.standard;
    result.qr_rank = evidence.qr_rank;
    result.smallest_kept_pivot = evidence.smallest_kept;
    result.largest_dropped_pivot = evidence.largest_dropped;
    result.exact_rank = evidence.exact_rank;
    result.exact_points = evidence.exact_points;
    result.modulo_prime_only = evidence.modulo_prime_only;
    return result;
}

/// Of what the model depends on: the description as read (comments and layout left out), its effects and the version.
std::string hash_inputs(const robot_model& model) {
    std::string text = std::string("idim ") + version() + "\n" + to_string(model.description);
    for (const effect_description& effect : model.effects) {
        text += fmt::format("effect {} {} {} {}\n", effect.name, static_cast<int>(effect.scope), effect.acts_on_both,
                            effect.torque.text);
        for (const linear_coefficient& coefficient : effect.linear) {
            text += fmt::format("  {} {} {}\n", coefficient.name, coefficient.unit,
                                coefficient.min ? fmt::format("{}", *coefficient.min) : "free");
        }
    }
    return content_hash(text);
}

rendered_file manifest(const generated_model& model) {
    nlohmann::ordered_json json;
    json["generator"] = std::string("idim ") + version();
    json["robot"] = model.robot;
    json["target"] = model.target;
    json["input_hash"] = model.input_hash;
    json["files"] = nlohmann::ordered_json::array();
    for (const rendered_file& file : model.files) {
        json["files"].push_back(file.name);
    }
    const auto add = [&json](const char* name, const operation_count& count) {
        json["operations"][name] = {{"mul", count.mul}, {"add", count.add}, {"div", count.div}};
    };
    add("inverse_dynamics", model.operations.inverse_dynamics);
    add("regressor", model.operations.regressor);
    add("mass_matrix", model.operations.mass_matrix);
    add("forward_dynamics", model.operations.forward_dynamics);
    return {"manifest.json", json.dump(2) + "\n"};
}

operation_table table(const model_operations& counts) {
    return {counts.inverse_dynamics, counts.regressor, counts.mass_matrix, counts.forward_dynamics};
}

}  // namespace

const char* version() {
    return IDIM_VERSION;
}

base_report find_base(const std::string& robot_file, const std::string& templates) {
    return report(load(robot_file, templates));
}

generated_model generate(const std::string& robot_file, const std::string& templates,
                         const generation_options& options) {
    const auto start = std::chrono::steady_clock::now();
    const robot_model model = load(robot_file, templates);
    generated_model result;
    result.robot = model.description.name;
    result.target = options.target;
    result.base = report(model);
    result.input_hash = hash_inputs(model);
    model_operations counts;
    const template_context context =
        build_context(model, {version(), result.input_hash}, languages_of(options.target), counts);
    result.joints = context.joints;
    result.operations = table(counts);
    result.files = render(context, templates + "/" + options.target);
    result.files.push_back(manifest(result));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.rigid_operations = table(count_rigid(load(robot_file, templates, true)));
    return result;
}

}  // namespace idim::generator
