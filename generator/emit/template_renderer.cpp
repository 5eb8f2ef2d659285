#include "emit/template_renderer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <kainjow/mustache.hpp>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace idim::generator {

namespace {

using kainjow::mustache::data;
using kainjow::mustache::mustache;

constexpr const char* suffix = ".mustache";

/// "function" and ".hpp" of "function.hpp".
std::pair<std::string, std::string> split(const std::string& name) {
    const std::size_t dot = std::min(name.find('.'), name.size());
    return {name.substr(0, dot), name.substr(dot)};
}

bool is_partial(const std::string& name) {
    return split(name).second.empty();
}

bool is_file(const std::string& name) {
    return !is_partial(name);
}

/// Templates of a folder without .mustache, in alphabetical order.
std::vector<std::string> template_names(const std::string& folder, bool (*wanted)(const std::string&)) {
    std::error_code error;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::filesystem::path& path = entry.path();
        if (path.extension() == suffix && wanted(path.stem().string())) {
            names.push_back(path.stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_template(const std::string& folder, const std::string& name) {
    const std::string path = folder + "/" + name;
    std::ifstream file(path);
    if (!file) {
        throw std::runtime_error("cannot read template " + path);
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Repeats the one line of a section, as it stands between the tags, for every text. The line break before the closing
/// tag is left to the one behind it.
std::string lay_out(const std::vector<std::string>& lines, const std::string& section) {
    const std::string tag = "{{text}}";
    const std::size_t at = section.find(tag);
    if (at == std::string::npos || section.front() != '\n' || section.back() != '\n') {
        throw std::runtime_error("template: expected one line with {{text}} between the tags of a section of lines");
    }
    const std::string before = section.substr(1, at - 1);
    const std::string after = section.substr(at + tag.size(), section.size() - 1 - at - tag.size());
    std::string text;
    for (const std::string& line : lines) {
        text.append(text.empty() ? "" : "\n").append(before).append(line).append(after);
    }
    return text;
}

/// Collects values and remembers every key, so that a key no one provides is an error instead of an empty string.
class context_data {
  public:
    void set(const std::string& key, const std::string& value) { keys_.insert(key), data_.set(key, value); }
    void set(const std::string& key, const std::vector<context_data>& list) {
        keys_.insert(key);
        data entries{data::type::list};
        for (const context_data& entry : list) {
            entries << entry.data_;
            keys_.insert(entry.keys_.begin(), entry.keys_.end());
        }
        data_.set(key, entries);
    }
    /// Lines of a section whose tag is "text"; the tag is known even where there is no line. A body has thousands of
    /// them, which the library would copy and look up one by one, so the section lays them out itself.
    void set_lines(const std::string& key, const std::vector<std::string>& lines) {
        keys_.insert({key, "text"});
        if (lines.empty()) {
            data_.set(key, data{data::type::list});
        } else {
            const auto shared = std::make_shared<const std::vector<std::string>>(lines);
            const auto layout = [shared](const std::string& section, const kainjow::mustache::renderer&) {
                return lay_out(*shared, section);
            };
            data_.set(key, data{kainjow::mustache::lambda2{layout}});
        }
    }
    /// The keys of an entry, for a list that may be empty.
    void know(const context_data& entry) { keys_.insert(entry.keys_.begin(), entry.keys_.end()); }
    void set_flag(const std::string& key, bool value) { keys_.insert(key), data_.set(key, value); }
    /// A partial stands on a line of its own, so its last line break is the template's.
    void set_partial(const std::string& key, std::string text) {
        keys_.insert(key);
        text.erase(text.find_last_not_of('\n') + 1);
        data_.set(key, data{kainjow::mustache::partial{[text] { return text; }}});
    }
    const data& values() const { return data_; }
    bool has(const std::string& key) const { return keys_.count(key) != 0; }

  private:
    data data_;
    std::set<std::string> keys_;
};

void check_keys(const std::string& text, const context_data& context, const std::string& name) {
    static const std::regex tag("\\{\\{[#^/>]?([a-z_]+)\\}\\}");
    for (std::sregex_iterator it(text.begin(), text.end(), tag); it != std::sregex_iterator(); ++it) {
        if (!context.has((*it)[1].str())) {
            throw std::runtime_error(
                fmt::format("template {}: key \"{}\" is not in the context", name, (*it)[1].str()));
        }
    }
}

/// The library prints the line of a section's tag, empty, where the section is not printed. It leaves the line out
/// where some section on it is, so each tag gets an empty one in front.
std::string without_empty_lines(const std::string& text) {
    static const std::regex opening("\\{\\{[#^]");
    return std::regex_replace(text, opening, "{{#always}}{{/always}}$&");
}

std::string filled(const std::string& folder, const std::string& name, const context_data& context) {
    const std::string text = read_template(folder, name + suffix);
    check_keys(text, context, name + suffix);
    mustache tmpl{without_empty_lines(text)};
    if (!tmpl.is_valid()) {
        throw std::runtime_error(fmt::format("template {}{}: {}", name, suffix, tmpl.error_message()));
    }
    tmpl.set_custom_escape([](const std::string& s) { return s; });
    return tmpl.render(context.values());
}

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

/// Arguments that functions take beside the motion, as the code around them spells each; its place is that in the
/// array of signals of model_interface.h.
class signal_arguments {
  public:
    explicit signal_arguments(const template_context& context)
        : context_(context),
          n_(context.joints.size()),
          motor_(n_ + context.states.size()),
          rigid_(motor_ + (context.has_elastic_joint ? 3 * n_ : 0)) {}

    using spelling = std::function<std::string(const std::string& name, std::size_t place)>;

    std::string text(const std::string& names, const spelling& spelled) const {
        const std::vector<std::tuple<std::string, bool, std::size_t>> all = {
            {"t", context_.uses_time, 0},
            {"temp", context_.uses_temperature, 0},
            {"state", !context_.states.empty(), n_},
            {"tau_rigid", context_.uses_rigid_torque, rigid_},
            {"motor", context_.has_elastic_joint, motor_}};
        std::string result;
        for (const auto& [name, used, place] : all) {
            const bool wanted = (" " + names + " ").find(" " + name + " ") != std::string::npos;
            result += used && wanted ? spelled(name, place) + ", " : "";
        }
        return result;
    }
    std::size_t motor_place() const { return motor_; }
    std::size_t rigid_place() const { return rigid_; }
    std::size_t count() const {
        const std::size_t further = rigid_ + (context_.uses_rigid_torque ? n_ : 0);
        return further > n_ || context_.uses_temperature ? further : 0;
    }

  private:
    const template_context& context_;
    std::size_t n_, motor_, rigid_;
};

std::string in_signals(const std::string& name, std::size_t place) {
    return name == "t" ? name : place == 0 ? "signals" : fmt::format("signals + {}", place);
}

std::string in_pack(const std::string& name, std::size_t /*place*/) {
    return "at." + name;
}

/// What the models read beside the motion.
void set_signals(context_data& result, const template_context& context) {
    const signal_arguments arguments(context);
    const auto without_load = [](const std::string& name, std::size_t place) {
        return name == "tau_rigid" ? "no_load" : in_signals(name, place);
    };
    result.set("time_argument", context.uses_time ? "double t" : "double");
    result.set("time_or_zero", context.uses_time ? "t" : "0.0");
    result.set("load_time_argument", context.has_payload ? "double t" : "double");
    result.set("load_time", context.has_payload ? "t, " : "");
    result.set("no_load_time", context.has_payload ? "std::numeric_limits<double>::infinity(), " : "");
    const auto argument = [](bool used) { return used ? "const double* signals" : "const double*"; };
    result.set("signals_argument", argument(arguments.count() > 0));
    result.set("state_signals_argument", argument(context.uses_temperature || !context.states.empty()));
    result.set("torque_signals_argument",
               argument(context.uses_temperature || !context.states.empty() || context.has_elastic_joint));
    result.set("first_signals_argument", argument(context.uses_temperature || context.has_elastic_joint));
    result.set("regressor_signals", arguments.text("t temp state tau_rigid motor", in_signals));
    result.set("torque_signals", arguments.text("t temp state motor", in_signals));
    result.set("bias_signals", arguments.text("t temp state", in_signals));
    result.set("first_signals", arguments.text("t temp motor", in_signals));
    result.set("start_signals", arguments.text("t temp state tau_rigid", without_load));
    result.set("packed_regressor_signals", arguments.text("t temp state tau_rigid motor", in_pack));
    result.set("packed_torque_signals", arguments.text("t temp state motor", in_pack));
    result.set("n_signals", std::to_string(arguments.count()));
    result.set("n_states", std::to_string(context.states.size()));
    result.set("state_place", std::to_string(context.joints.size()));
    result.set("motor_place", std::to_string(arguments.motor_place()));
    result.set("rigid_place", std::to_string(arguments.rigid_place()));
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

/// What every template may use.
context_data robot_values(const template_context& context, const std::string& folder) {
    context_data result;
    result.set_flag("always", true);
    for (const std::string& name : template_names(folder, is_partial)) {
        result.set_partial(name, read_template(folder, name + suffix));
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

}  // namespace

std::vector<rendered_file> render(const template_context& context, const std::string& folder) {
    const std::vector<std::string> names = template_names(folder, is_file);
    if (names.empty()) {
        throw std::runtime_error("no templates in " + folder);
    }
    std::vector<rendered_file> files;
    const context_data of_robot = robot_values(context, folder);
    for (const std::string& name : names) {
        const auto [stem, extension] = split(name);
        if (stem != "function") {
            context_data values = of_robot;
            values.set("functions", functions(context.functions));
            files.push_back({(stem == "robot" ? context.robot : stem) + extension, filled(folder, name, values)});
            continue;
        }
        for (const function_context& function : context.functions) {
            for (const variant_context& variant : function.variants) {
                context_data values = of_robot;
                set_function(values, function);
                set_variant(values, variant);
                files.push_back({function.name + variant.suffix + extension, filled(folder, name, values)});
            }
        }
    }
    return files;
}

}  // namespace idim::generator
