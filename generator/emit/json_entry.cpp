#include "emit/json_entry.hpp"

#include <algorithm>
#include <cmath>

namespace idim::generator {

using json = nlohmann::ordered_json;

json_entry::json_entry(const json& value, input_location where) : value_(value), where_(std::move(where)) {}

json_entry json_entry::at(const std::string& key) const {
    if (const std::optional<json_entry> found = find(key)) {
        return *found;
    }
    const json_entry missing(value_, place(key));
    missing.reject("an entry");
}

std::optional<json_entry> json_entry::find(const std::string& key) const {
    if (!value_.is_object()) {
        reject("a map");
    }
    const auto found = value_.find(key);
    return found == value_.end() ? std::nullopt : std::optional(json_entry(*found, place(key)));
}

std::vector<json_entry> json_entry::items() const {
    if (!value_.is_array()) {
        reject("a list");
    }
    std::vector<json_entry> result;
    for (const json& element : value_) {
        result.emplace_back(element, place(std::to_string(result.size() + 1)));
    }
    return result;
}

std::vector<std::pair<std::string, json_entry>> json_entry::entries() const {
    if (!value_.is_object()) {
        reject("a map");
    }
    std::vector<std::pair<std::string, json_entry>> result;
    for (const auto& [key, element] : value_.items()) {
        result.emplace_back(checked(key), json_entry(element, place(key)));
    }
    return result;
}

std::string json_entry::text() const {
    if (!value_.is_string()) {
        reject("a text");
    }
    return checked(value_.get<std::string>());
}

std::vector<std::string> json_entry::texts() const {
    std::vector<std::string> result;
    for (const json_entry& item : items()) {
        result.push_back(item.text());
    }
    return result;
}

double json_entry::number() const {
    if (!value_.is_number() || !std::isfinite(value_.get<double>())) {
        reject("a number");
    }
    return value_.get<double>();
}

bool json_entry::flag() const {
    if (!value_.is_boolean()) {
        reject("true or false");
    }
    return value_.get<bool>();
}

int json_entry::count() const {
    constexpr double most = 1e9;
    if (!value_.is_number_integer() || value_.get<double>() < 0.0 || value_.get<double>() > most) {
        reject("a count");
    }
    return value_.get<int>();
}

void json_entry::reject(const std::string& expected) const {
    throw input_error(where_, "expected " + expected + ", written by another version of idim? regenerate the folder");
}

input_location json_entry::place(const std::string& key) const {
    return {where_.file, where_.line, where_.field + (where_.field.empty() ? "" : ".") + key};
}

std::string json_entry::checked(const std::string& text) const {
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    if (std::any_of(text.begin(), text.end(), is_control)) {
        reject("text without control characters");
    }
    return text;
}

}  // namespace idim::generator
