#include "emit/context_data.hpp"

#include <stdexcept>

namespace idim::generator {

namespace {

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

}  // namespace

context_data::data& context_data::place(const std::string& key) {
    keys_.insert(key);
    return values_[key];
}

void context_data::set(const std::string& key, const std::vector<context_data>& list) {
    data entries{data::type::list};
    for (const context_data& entry : list) {
        entries << entry.values_;
        know(entry);
    }
    place(key) = std::move(entries);
}

void context_data::set_lines(const std::string& key, const std::vector<std::string>& lines) {
    keys_.insert("text");
    if (lines.empty()) {
        place(key) = data(data::type::list);
        return;
    }
    const auto layout = [&lines](const std::string& section, const kainjow::mustache::renderer&) {
        return lay_out(lines, section);
    };
    place(key) = data(kainjow::mustache::lambda2{layout});
}

void context_data::set_partial(const std::string& key, std::string text) {
    text.erase(text.find_last_not_of('\n') + 1);
    place(key) = data(kainjow::mustache::partial{[text] { return text; }});
}

}  // namespace idim::generator
