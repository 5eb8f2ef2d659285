#include "description/yaml_reader.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "description/text_file.hpp"

namespace idim::generator {

enum class yaml_kind { empty, scalar, list, map };

struct yaml_node {
    yaml_kind kind = yaml_kind::empty;
    int line = 0;
    std::string text;
    std::vector<yaml_node> children;  ///< list items; for a map its keys and values in turn
};

namespace {

constexpr std::size_t largest_description = 1'000'000;
constexpr std::size_t deepest_level = 20;
constexpr std::size_t longest_quote = 40;
constexpr std::size_t longest_text = 4096;

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// Builds yaml_nodes from parser events. YAML::Load is not used: it resolves aliases and has no limit of depth of ours.
class node_builder : public YAML::EventHandler {
  public:
    explicit node_builder(const std::string& file) : file_(file) {}

    yaml_node take_root() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(mark, yaml_kind::empty, ""); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        throw input_error({file_, mark.line + 1, ""}, "YAML aliases (*name) are not read, write the value itself");
    }
    void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& value) override {
        add(mark, yaml_kind::scalar, value);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        open(mark, yaml_kind::list);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
        open(mark, yaml_kind::map);
    }
    void OnMapEnd() override { close(); }

  private:
    void add(const YAML::Mark& mark, yaml_kind kind, const std::string& text) {
        put(yaml_node{kind, mark.line + 1, text, {}});
    }

    void open(const YAML::Mark& mark, yaml_kind kind) {
        if (open_.size() >= deepest_level) {
            throw input_error({file_, mark.line + 1, ""},
                              "lists and maps nested more than " + std::to_string(deepest_level) + " levels deep");
        }
        open_.push_back(yaml_node{kind, mark.line + 1, "", {}});
    }

    void close() {
        yaml_node node = std::move(open_.back());
        open_.pop_back();
        put(std::move(node));
    }

    void put(yaml_node node) {
        if (open_.empty()) {
            root_ = std::move(node);
        } else {
            open_.back().children.push_back(std::move(node));
        }
    }

    std::string file_;
    yaml_node root_;
    std::vector<yaml_node> open_;
};

std::string path_of(const std::string& parent, std::string_view key) {
    const bool plain = std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    const std::string step = plain && key.size() <= 64 ? std::string(key) : quote(key);
    return parent.empty() ? step : parent + "." + step;
}

std::string what_stands_here(const yaml_node& node) {
    switch (node.kind) {
        case yaml_kind::empty:
            return "nothing";
        case yaml_kind::scalar:
            return quote(node.text);
        case yaml_kind::list:
            return "a list";
        case yaml_kind::map:
            return "a map";
    }
    return "nothing";
}

}  // namespace

std::string quote(std::string_view text) {
    constexpr char digits[] = "0123456789abcdef";
    std::string result = "\"";
    for (const char c : text.substr(0, longest_quote)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte >= 0x7f) {
            result += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
        } else {
            if (c == '"' || c == '\\') {
                result += '\\';
            }
            result += c;
        }
    }
    return result + (text.size() > longest_quote ? "...\"" : "\"");
}

std::optional<double> as_number(std::string_view text) {
    std::string_view digits = text;
    if (!digits.empty() && (digits.front() == '+' || digits.front() == '-')) {
        digits.remove_prefix(1);
    }
    std::string word(digits.substr(0, 5));
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (digits.size() <= 5 && (word == ".nan" || word == ".inf")) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    // from_chars alone would also take a second sign and the words nan and inf.
    if (digits.empty() || !((digits.front() >= '0' && digits.front() <= '9') || digits.front() == '.')) {
        return std::nullopt;
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range) {
        return std::numeric_limits<double>::infinity();
    }
    return text.front() == '-' ? -value : value;
}

bool yaml_value::is_scalar() const {
    return node_->kind == yaml_kind::scalar;
}
bool yaml_value::is_list() const {
    return node_->kind == yaml_kind::list;
}
bool yaml_value::is_map() const {
    return node_->kind == yaml_kind::map;
}

std::string yaml_value::text(std::string_view expected) const {
    if (!is_scalar() || node_->text.empty() || std::any_of(node_->text.begin(), node_->text.end(), is_control)) {
        reject(expected);
    }
    return node_->text;
}

std::string yaml_value::paragraph(std::string_view expected) const {
    if (!is_scalar() || node_->text.empty()) {
        reject(expected);
    }
    std::string result = node_->text;
    std::replace_if(result.begin(), result.end(), is_control, ' ');
    result.erase(result.find_last_not_of(' ') + 1);
    return result;
}

std::string yaml_value::expression() const {
    const std::string result = text("a number or an expression");
    const std::optional<double> number = as_number(result);
    if (number && !std::isfinite(*number)) {
        reject("a finite number or an expression");
    }
    if (result.size() > longest_text) {
        reject("an expression of at most " + std::to_string(longest_text) + " characters");
    }
    return result;
}

double yaml_value::number() const {
    const std::optional<double> value = is_scalar() ? as_number(node_->text) : std::nullopt;
    if (!value) {
        reject("a number");
    }
    if (!std::isfinite(*value)) {
        reject("a finite number");
    }
    return *value;
}

double yaml_value::positive_number() const {
    const double value = number();
    if (value <= 0.0) {
        reject("a positive number");
    }
    return value;
}

std::vector<yaml_value> yaml_value::items(std::string_view expected) const {
    if (!is_list()) {
        reject(expected);
    }
    std::vector<yaml_value> result;
    for (std::size_t i = 0; i < node_->children.size(); ++i) {
        const yaml_node& item = node_->children[i];
        result.emplace_back(std::shared_ptr<const yaml_node>(node_, &item),
                            input_location{where_.file, item.line, where_.field + "[" + std::to_string(i + 1) + "]"});
    }
    return result;
}

std::vector<std::pair<std::string, yaml_value>> yaml_value::entries(std::string_view expected) const {
    if (!is_map()) {
        reject(expected);
    }
    std::vector<std::pair<std::string, yaml_value>> result;
    std::map<std::string, int> first_lines;
    for (std::size_t i = 0; i + 1 < node_->children.size(); i += 2) {
        const yaml_node& key = node_->children[i];
        const yaml_node& value = node_->children[i + 1];
        if (key.kind != yaml_kind::scalar) {
            throw input_error({where_.file, key.line, where_.field},
                              "expected a plain name as key, got " + what_stands_here(key));
        }
        const auto [first, is_new] = first_lines.emplace(key.text, key.line);
        if (!is_new) {
            throw input_error({where_.file, key.line, where_.field},
                              "duplicate key " + quote(key.text) + ", first on line " + std::to_string(first->second));
        }
        // The parser reports an absent value at the token after it.
        const int line = value.kind == yaml_kind::empty ? key.line : value.line;
        result.emplace_back(key.text, yaml_value(std::shared_ptr<const yaml_node>(node_, &value),
                                                 {where_.file, line, path_of(where_.field, key.text)}));
    }
    return result;
}

void yaml_value::reject(std::string_view expected) const {
    throw input_error(where_, "expected " + std::string(expected) + ", got " + what_stands_here(*node_));
}

input_location in_field(const input_location& map, const std::string& key) {
    return {map.file, map.line, path_of(map.field, key)};
}

yaml_fields::yaml_fields(const yaml_value& map, std::initializer_list<std::string_view> allowed) : where_(map.where()) {
    std::string names;
    for (const std::string_view name : allowed) {
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    entries_ = map.entries("a map with keys among " + names);
    for (const auto& [key, value] : entries_) {
        if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
            throw input_error({where_.file, value.where().line, where_.field},
                              "unknown key " + quote(key) + ", expected one of " + names);
        }
    }
}

std::optional<yaml_value> yaml_fields::find(std::string_view key) const {
    for (const auto& [name, value] : entries_) {
        if (name == key) {
            return value;
        }
    }
    return std::nullopt;
}

yaml_value yaml_fields::require(std::string_view key, std::string_view expected) const {
    const std::optional<yaml_value> value = find(key);
    if (!value) {
        throw input_error(in_field(where_, std::string(key)), "missing, expected " + std::string(expected));
    }
    return *value;
}

yaml_value read_yaml(const std::string& file) {
    const std::string text = read_text_file(file, largest_description);
    std::istringstream stream(text);
    node_builder builder(file);
    try {
        YAML::Parser parser(stream);
        if (!parser.HandleNextDocument(builder)) {
            throw input_error({file, 0, ""}, "is empty");
        }
        node_builder second(file);
        if (parser.HandleNextDocument(second)) {
            throw input_error({file, second.take_root().line, ""}, "a second YAML document, expected one per file");
        }
    } catch (const YAML::Exception& error) {
        throw input_error({file, error.mark.is_null() ? 0 : error.mark.line + 1, ""}, "not YAML: " + error.msg);
    }
    auto root = std::make_shared<const yaml_node>(builder.take_root());
    const int line = root->line;
    return yaml_value(std::move(root), {file, line, ""});
}

}  // namespace idim::generator
