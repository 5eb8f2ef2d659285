#include "emit/template_renderer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <kainjow/mustache.hpp>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace idim::generator {

namespace {

using kainjow::mustache::data;
using kainjow::mustache::mustache;

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

std::string render(const std::string& folder, const std::string& name, const context_data& context) {
    const std::string text = read_template(folder, name);
    check_keys(text, context, name);
    mustache tmpl{text};
    if (!tmpl.is_valid()) {
        throw std::runtime_error(fmt::format("template {}: {}", name, tmpl.error_message()));
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
    }
    return result;
}

context_data common(const template_context& context, const std::string& folder) {
    context_data result;
    result.set_partial("preamble", read_template(folder, "preamble.mustache"));
    result.set("robot", context.robot);
    result.set("version", context.version);
    result.set("robot_file", context.robot_file);
    result.set("input_hash", context.input_hash);
    return result;
}

std::string operation_text(const operation_count& count) {
    std::string text = fmt::format("{} mul, {} add, {} div", count.mul, count.add, count.div);
    return count.functions == 0 ? text : text + fmt::format(", {} functions (sin, cos, sign ...)", count.functions);
}

rendered_file function_file(const template_context& context, const function_context& function,
                            const std::string& folder) {
    context_data values = common(context, folder);
    values.set("name", function.name);
    values.set("summary", function.summary);
    values.set("operations", operation_text(function.operations));
    std::vector<context_data> meanings;
    std::vector<std::string> declarations;
    for (const argument_context& argument : function.arguments) {
        meanings.emplace_back().set("meaning", argument.meaning);
        declarations.push_back((argument.used ? "" : "[[maybe_unused]] ") + argument.declaration);
    }
    values.set("arguments", meanings);
    const std::string indent = ",\n" + std::string(function.name.size() + 6, ' ');
    values.set("argument_list", fmt::format("{}", fmt::join(declarations, indent)));
    values.set_lines("statements", function.statements);
    std::vector<std::string> usings;
    for (const std::string& name : function.functions) {
        usings.push_back("std::" + name);
    }
    using lines = std::vector<std::string>;
    values.set_lines("using_functions", usings.empty() ? lines{} : lines{fmt::format("{}", fmt::join(usings, ", "))});
    return {function.name + ".hpp", render(folder, "function.hpp.mustache", values)};
}

rendered_file metadata_file(const template_context& context, const std::string& folder) {
    context_data values = common(context, folder);
    values.set_lines("constants", context.constants);
    values.set_lines("effects", context.effects);
    values.set("dof", std::to_string(context.joints.size()));
    values.set("n_base", std::to_string(context.base_parameters.size()));
    values.set("n_standard", std::to_string(context.standard_parameters.size()));
    values.set("joints", joints(context.joints));
    values.set("base_parameters", parameters(context.base_parameters));
    values.set("standard_parameters", parameters(context.standard_parameters));
    return {"model.hpp", render(folder, "model.hpp.mustache", values)};
}

rendered_file interface_file(const template_context& context, const std::string& folder) {
    context_data values = common(context, folder);
    values.set("joints", joints(context.joints));
    values.set("time_argument", context.uses_time ? "double t" : "double");
    values.set("temp_argument", context.uses_temperature ? "const double* temp" : "const double*");
    values.set("signals", std::string(context.uses_time ? "t, " : "") + (context.uses_temperature ? "temp, " : ""));
    values.set("needs_time", context.uses_time ? "1" : "0");
    values.set("needs_temperature", context.uses_temperature ? "1" : "0");
    return {"model_interface.cpp", render(folder, "model_interface.cpp.mustache", values)};
}

}  // namespace

std::vector<rendered_file> render_cpp(const template_context& context, const std::string& folder) {
    std::vector<rendered_file> files;
    for (const function_context& function : context.functions) {
        files.push_back(function_file(context, function, folder));
    }
    files.push_back({"functions.hpp", render(folder, "functions.hpp.mustache", common(context, folder))});
    files.push_back(metadata_file(context, folder));
    files.push_back(interface_file(context, folder));
    return files;
}

}  // namespace idim::generator
