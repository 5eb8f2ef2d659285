#include "description/effect_insertion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

/// Place just behind the line that holds `place`.
std::size_t line_end(const std::string& text, std::size_t place) {
    const std::size_t end = text.find('\n', place);
    return end == std::string::npos ? text.size() : end + 1;
}

/// Places of text between quotes and behind # are passed over.
std::size_t skip_quoted(const std::string& text, std::size_t place) {
    const char mark = text[place];
    if (mark == '#' && (place == 0 || std::isspace(static_cast<unsigned char>(text[place - 1])) != 0)) {
        return line_end(text, place) - 1;
    }
    if (mark == '"' || mark == '\'') {
        std::size_t end = place + 1;
        while (end < text.size() && text[end] != mark) {
            end += mark == '"' && text[end] == '\\' ? 2U : 1U;
        }
        return end;
    }
    return place;
}

/// Place of the bracket that closes the one at `open`.
std::size_t closing_bracket(const std::string& text, std::size_t open, const std::string& file) {
    int depth = 0;
    for (std::size_t k = open; k < text.size(); ++k) {
        k = skip_quoted(text, k);
        if (k >= text.size()) {
            break;
        }
        depth += text[k] == '[' || text[k] == '{' ? 1 : 0;
        depth -= text[k] == ']' || text[k] == '}' ? 1 : 0;
        if (depth == 0) {
            return k;
        }
    }
    throw input_error({file, 0, "effects"}, "expected a closing bracket");
}

std::string in_flow_list(const std::string& text, std::size_t open, bool empty, const std::vector<effect_item>& items,
                         const std::string& file) {
    const std::size_t close = closing_bracket(text, open, file);
    std::string added;
    for (const effect_item& item : items) {
        added += (empty && added.empty() ? "" : ", ") + to_yaml(item);
    }
    return text.substr(0, close) + added + text.substr(close);
}

/// Behind the lines of the list's last item: the first line at or left of its indentation that is no comment.
std::string in_block_list(const std::string& text, const YAML::Mark& last, int column,
                          const std::vector<effect_item>& items) {
    std::size_t place = line_end(text, static_cast<std::size_t>(last.pos));
    while (place < text.size()) {
        const std::size_t end = line_end(text, place);
        const std::size_t first = text.find_first_not_of(" \t\r\n", place);
        if (first == std::string::npos || first >= end || static_cast<int>(first - place) <= column) {
            break;
        }
        place = end;
    }
    std::string added;
    for (const effect_item& item : items) {
        added += std::string(static_cast<std::size_t>(column), ' ') + "- " + to_yaml(item) + "\n";
    }
    const bool ends = place == 0 || text[place - 1] == '\n';
    return text.substr(0, place) + (ends ? "" : "\n") + added + text.substr(place);
}

}  // namespace

std::string to_yaml(const effect_item& item) {
    std::string text = "{effect: " + item.effect;
    if (!item.joints.empty()) {
        text += fmt::format(", joints: [{}]", fmt::join(item.joints, ", "));
    }
    if (!item.from.empty()) {
        text += fmt::format(", from: [{}]", fmt::join(item.from, ", "));
    }
    if (!item.shape.empty()) {
        std::vector<std::string> values;
        for (const auto& [name, value] : item.shape) {
            values.push_back(fmt::format("{}: {}", name, value));
        }
        text += fmt::format(", shape: {{{}}}", fmt::join(values, ", "));
    }
    return text + "}";
}

std::string with_effects(const std::string& text, const std::vector<effect_item>& items, const std::string& file) {
    if (items.empty()) {
        return text;
    }
    YAML::Node root;
    try {
        root = YAML::Load(text);
    } catch (const YAML::ParserException& error) {
        throw input_error({file, error.mark.line + 1, ""}, "malformed: " + error.msg);
    }
    const YAML::Node list = root["effects"];
    if (!list || !list.IsSequence()) {
        std::string added = text.empty() || text.back() == '\n' ? "effects:\n" : "\neffects:\n";
        for (const effect_item& item : items) {
            added += "  - " + to_yaml(item) + "\n";
        }
        if (list) {
            throw input_error({file, list.Mark().line + 1, "effects"}, "expected a list");
        }
        return text + added;
    }
    const auto start = static_cast<std::size_t>(list.Mark().pos);
    if (start < text.size() && text[start] == '[') {
        return in_flow_list(text, start, list.size() == 0, items, file);
    }
    return in_block_list(text, list[list.size() - 1].Mark(), list.Mark().column, items);
}

}  // namespace idim::generator
