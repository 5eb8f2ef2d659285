#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "idim/input_error.hpp"

namespace idim::generator {

/// A value of a JSON text that may be anything, with the place it stands in. Every question but find throws input_error
/// where the value is of another kind; text with control characters is refused, as it is shown to people and would give
/// orders to their terminal. The JSON has to outlive it.
class json_entry {
  public:
    json_entry(const nlohmann::ordered_json& value, input_location where);

    json_entry at(const std::string& key) const;
    std::optional<json_entry> find(const std::string& key) const;  ///< throws where this is no map
    std::vector<json_entry> items() const;
    std::vector<std::pair<std::string, json_entry>> entries() const;
    std::string text() const;
    std::vector<std::string> texts() const;
    double number() const;
    bool flag() const;
    int count() const;
    [[noreturn]] void reject(const std::string& expected) const;

  private:
    input_location place(const std::string& key) const;
    std::string checked(const std::string& text) const;

    const nlohmann::ordered_json& value_;
    input_location where_;
};

}  // namespace idim::generator
