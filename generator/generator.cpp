#include "generator.hpp"

#include <fmt/format.h>

#include <chrono>

#include "backend/model_manifest.hpp"
#include "dynamics/effect_terms.hpp"
#include "emit/content_hash.hpp"
#include "emit/manifest_file.hpp"

namespace idim::generator {

namespace {

robot_model load(const std::string& robot_file, const std::string& templates) {
    robot_model model;
    model.description = read_robot(robot_file);
    for (const effect_use& use : model.description.effects) {
        model.effects.push_back(find_effect(use, model.description, templates + "/effects"));
    }
    model.tree = build_kinematic_tree(model.description);
    if (model.tree.dof() == 0) {
        throw input_error({robot_file, 0, "joints"}, "expected at least one revolute or prismatic joint");
    }
    tilt_gravity(model.description.effects, model.effects, model.tree);
    model.parameters = list_parameters(model.tree, model.description.effects, model.effects);
    model.base = find_base_parameters(model.tree, model.parameters);
    return model;
}

base_report report(const robot_model& model) {
    base_report result;
    result.robot = model.description.name;
    result.notes = model.description.notes;
    for (const base_parameter& base : model.base.parameters) {
        result.parameters.push_back({base.name, base.unit, base.formula, model.parameters.all[base.standard].per_log});
    }
    for (const std::size_t p : model.base.without_effect) {
        result.without_effect.push_back(model.parameters.all[p].name);
    }
    for (const standard_parameter& p : model.parameters.all) {
        const int inertial = p.kind == parameter_kind::effect ? -1 : static_cast<int>(p.kind);
        result.standard_parameters.push_back(
            {p.name, p.unit, model.tree.joints[static_cast<std::size_t>(p.joint)].name, inertial, p.gate, p.min});
    }
    const rank_evidence& evidence = model.base.evidence;
    result.standard = model.base.standard;
    result.qr_rank = evidence.qr_rank;
    result.smallest_kept_pivot = evidence.smallest_kept;
    result.largest_dropped_pivot = evidence.largest_dropped;
    result.exact_rank = evidence.exact_rank;
    result.exact_points = evidence.exact_points;
    result.modulo_prime_only = evidence.modulo_prime_only;
    result.has_loops = !model.tree.closures.empty();
    return result;
}

/// Of what the model depends on: the description as read (comments and layout left out), its effects, what it was made
/// cheap for, whether it has derivatives, and the version.
std::string hash_inputs(const robot_model& model, const generation_options& options) {
    std::string text = fmt::format("idim {}\ncost {}\n{}", version(), options.cost, to_string(model.description));
    text += options.derivatives ? "derivatives\n" : "";
    for (const effect_description& effect : model.effects) {
        text += fmt::format("effect {} {} {} {}\n", effect.name, static_cast<int>(effect.scope), effect.acts_on_both,
                            law_of(effect));
        for (const linear_coefficient& coefficient : effect.linear) {
            text += fmt::format("  {} {} {}\n", coefficient.name, coefficient.unit,
                                coefficient.min ? fmt::format("{}", *coefficient.min) : "free");
        }
    }
    return content_hash(text);
}

/// The manifest of what was rendered, as a file beside it.
rendered_file manifest_of(const robot_model& model, const template_context& context, const generated_model& generated) {
    manifest content = describe(model, context);
    content.target = generated.target;
    for (const rendered_file& file : generated.files) {
        content.files.push_back(file.name);
    }
    return {manifest_name, to_json_text(content)};
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
    result.cost = options.cost;
    result.input_hash = hash_inputs(model, options);
    const cost_target target = cost_target_of(options.cost);
    operation_counts counts;
    const template_context context = build_context(model, {version(), result.input_hash, target}, options.derivatives,
                                                   languages_of(options.target), counts);
    result.joints = context.joints;
    result.operations = table(counts.declared);
    result.rigid_operations = table(counts.rigid);
    result.files = render(context, templates + "/" + options.target);
    result.files.push_back(manifest_of(model, context, result));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace idim::generator
