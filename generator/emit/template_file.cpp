#include "emit/template_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace idim::generator {

namespace {

constexpr const char* template_suffix = ".mustache";

std::vector<std::string> keys_of(const std::string& text) {
    std::vector<std::string> keys;
    for (std::size_t tag = text.find("{{"); tag != std::string::npos; tag = text.find("{{", tag + 2)) {
        const std::size_t key = text.find_first_not_of("#^/>", tag + 2);
        keys.push_back(text.substr(key, text.find("}}", key) - key));
    }
    return keys;
}

/// The library prints the line of a section's tag, empty, where the section is not printed. It leaves the line out
/// where some section on it is, so each tag gets an empty one in front.
std::string without_empty_lines(const std::string& text) {
    std::string result;
    std::size_t from = 0;
    for (std::size_t tag = text.find("{{"); tag != std::string::npos; tag = text.find("{{", tag + 2)) {
        const bool opens = text.compare(tag + 2, 1, "#") == 0 || text.compare(tag + 2, 1, "^") == 0;
        result.append(text, from, tag - from).append(opens ? "{{#always}}{{/always}}" : "");
        from = tag;
    }
    return result.append(text, from);
}

}  // namespace

template_names::template_names(const std::string& folder) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::filesystem::path& path = entry.path();
        if (path.extension() == template_suffix) {
            const std::string name = path.stem().string();
            (name.find('.') == std::string::npos ? partials : files).push_back(name);
        }
    }
    std::sort(files.begin(), files.end());
    std::sort(partials.begin(), partials.end());
}

std::string read_template(const std::string& folder, const std::string& name) {
    const std::string path = folder + "/" + name + template_suffix;
    std::ifstream file(path);
    if (!file) {
        throw std::runtime_error("cannot read template " + path);
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

template_file::template_file(const std::string& folder, const std::string& name)
    : name_(name + template_suffix), content_("") {
    const std::string text = read_template(folder, name);
    content_ = kainjow::mustache::mustache(without_empty_lines(text));
    if (!content_.is_valid()) {
        throw std::runtime_error(fmt::format("template {}: {}", name_, content_.error_message()));
    }
    content_.set_custom_escape([](const std::string& value) { return value; });
    keys_ = keys_of(text);
}

std::string template_file::filled(std::initializer_list<const context_data*> contexts) {
    for (const std::string& key : keys_) {
        const auto has_key = [&key](const context_data* context) { return context->has(key); };
        if (std::none_of(contexts.begin(), contexts.end(), has_key)) {
            throw std::runtime_error(fmt::format("template {}: key \"{}\" is not in the context", name_, key));
        }
    }
    kainjow::mustache::context<std::string> values;
    for (const context_data* context : contexts) {
        values.push(&context->values());
    }
    return content_.render(values);
}

}  // namespace idim::generator
