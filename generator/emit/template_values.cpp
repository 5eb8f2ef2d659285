#include "emit/template_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "emit/signal_values.hpp"
#include "emit/template_file.hpp"

namespace idim::generator {

namespace {

std::vector<context_data> parameters(const std::vector<parameter_context>& list) {
    std::vector<context_data> result;
    for (const parameter_context& parameter : list) {
        context_data& entry = result.emplace_back();
        entry.set("name", parameter.name);
        entry.set("unit", parameter.unit);
        entry.set("regroups", parameter.regroups);
        entry.set("per_log", parameter.per_log ? "1" : "0");
    }
    return result;
}

std::vector<context_data> joints(const std::vector<joint_context>& list) {
    std::vector<context_data> result;
    for (const joint_context& joint : list) {
        context_data& entry = result.emplace_back();
        entry.set("name", joint.name);
        entry.set("prismatic", joint.prismatic ? "1" : "0");
        entry.set("drive_gain", fmt::format("{}", joint.drive_gain));
        entry.set("velocity_limit", fmt::format("{}", joint.velocity_limit));
        entry.set("position_unit", joint.position_unit);
        entry.set("torque_delay", fmt::format("{}", joint.torque_delay));
        entry.set("stiffness", fmt::format("{}", joint.stiffness));
        entry.set("damping", fmt::format("{}", joint.damping));
    }
    return result;
}

std::string operation_text(const operation_count& count) {
    std::string text = fmt::format("{} mul, {} add, {} div", count.mul, count.add, count.div);
    return count.functions == 0 ? text : text + fmt::format(", {} functions (sin, cos, sign ...)", count.functions);
}

std::vector<context_data> routines(const std::vector<routine_context>& list) {
    std::vector<context_data> result;
    for (const routine_context& routine : list) {
        context_data& entry = result.emplace_back();
        entry.set("summary", routine.summary);
        entry.set_lines("arguments", routine.meanings);
        entry.set("signature", routine.signature);
        entry.set_lines("prologue", routine.prologue);
        entry.set_lines("statements", routine.statements);
    }
    return result;
}

void set_function(context_data& values, const function_context& function) {
    values.set("name", function.name);
    values.set("summary", function.summary);
    values.set_lines("arguments", function.meanings);
    values.set("operations", operation_text(function.operations));
}

void set_variant(context_data& values, const variant_context& variant) {
    values.set("scalar", variant.scalar);
    values.set_flag("calls_sign", variant.calls_sign);
    values.set("routines", routines(variant.routines));
    values.know(routines({routine_context{}}).front());
}

bool has_routines(const function_context& function) {
    return !function.variants.empty() && !function.variants.front().routines.empty();
}

std::vector<context_data> functions(const std::vector<function_context>& list) {
    std::vector<context_data> result;
    for (const function_context& function : list) {
        if (!has_routines(function)) {
            continue;
        }
        context_data& entry = result.emplace_back();
        set_function(entry, function);
        std::vector<context_data> variants;
        for (const variant_context& variant : function.variants) {
            set_variant(variants.emplace_back(), variant);
        }
        entry.set("variants", variants);
    }
    return result;
}

std::string upper_case(std::string text) {
    for (char& letter : text) {
        letter = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    }
    return text;
}

std::vector<context_data> named(const std::vector<std::string>& names) {
    std::vector<context_data> result;
    for (const std::string& name : names) {
        result.emplace_back().set("name", name);
    }
    return result;
}

/// Parts that only some robots have.
void set_optional_parts(context_data& result, const template_context& context) {
    const bool has_states = !context.states.empty();
    const bool gives_rigid_torque = context.uses_rigid_torque || context.has_elastic_joint;
    const auto or_null = [](bool there, const char* name) { return there ? name : "nullptr"; };
    result.set("states", named(context.states));
    result.know(named({""}).front());
    result.set_flag("has_states", has_states);
    result.set_flag("has_elastic_joint", context.has_elastic_joint);
    result.set_flag("has_payload", context.has_payload);
    result.set_flag("uses_rigid_torque", context.uses_rigid_torque);
    result.set_flag("gives_rigid_torque", gives_rigid_torque);
    const auto is_plain = [](const joint_context& joint) {
        return joint.torque_delay == 0.0 && joint.stiffness == 0.0;
    };
    result.set_flag("has_drive_model", !std::all_of(context.joints.begin(), context.joints.end(), is_plain));
    result.set("needs_rigid_torque", context.uses_rigid_torque ? "1" : "0");
    result.set("with_rigid_argument", context.uses_rigid_torque ? ", bool with_rigid_torque" : "");
    result.set("with_rigid", context.uses_rigid_torque ? ", true" : "");
    result.set("without_rigid", context.uses_rigid_torque ? ", false" : "");
    result.set("state_names_table", or_null(has_states, "model::state_names.data()"));
    result.set("rigid_torque_function", or_null(gives_rigid_torque, "rigid_torque"));
    result.set("first_states_function", or_null(has_states, "first_states"));
    result.set("next_states_function", or_null(has_states, "next_states"));
    result.set_flag("has_closures", context.closures > 0);
    result.set("n_closures", std::to_string(context.closures));
    result.set("closure_function", or_null(context.closures > 0, "closure"));
}

}  // namespace

context_data robot_values(const template_context& context, const std::string& folder,
                          const std::vector<std::string>& partials) {
    context_data result;
    result.set_flag("always", true);
    for (const std::string& name : partials) {
        result.set_partial(name, read_template(folder, name));
    }
    result.set("robot", context.robot);
    result.set("robot_upper", upper_case(context.robot));
    result.set("version", context.version);
    result.set("robot_file", context.robot_file);
    result.set("input_hash", context.input_hash);
    result.set_lines("constants", context.constants);
    result.set_lines("effects", context.effects);
    result.set("dof", std::to_string(context.joints.size()));
    result.set("n_base", std::to_string(context.base_parameters.size()));
    result.set("n_standard", std::to_string(context.standard_parameters.size()));
    result.set("n_sines", std::to_string(context.sines));
    result.set("joints", joints(context.joints));
    result.set("base_parameters", parameters(context.base_parameters));
    result.set("standard_parameters", parameters(context.standard_parameters));
    set_signals(result, context);
    set_optional_parts(result, context);
    result.set_flag("uses_time", context.uses_time);
    result.set_flag("uses_temperature", context.uses_temperature);
    result.set("needs_time", context.uses_time ? "1" : "0");
    result.set("needs_temperature", context.uses_temperature ? "1" : "0");
    return result;
}

context_data values_of_functions(const std::vector<function_context>& list) {
    context_data result;
    result.set("functions", functions(list));
    return result;
}

context_data values_of_function(const function_context& function, const variant_context& variant) {
    context_data result;
    set_function(result, function);
    set_variant(result, variant);
    return result;
}

}  // namespace idim::generator
