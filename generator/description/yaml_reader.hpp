#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "idim/input_error.hpp"

namespace idim::generator {

/// `text` in double quotes for an error message: control and non-ASCII characters as \xNN, cut after 40 characters, so
/// that a message stays one short line whatever the input holds.
std::string quote(std::string_view text);

struct yaml_node;

/// One value of a YAML file with the place it stands in: where().line is its line, where().field its path from the
/// root, list items counted from 1 ("joints[2].theta"). Every accessor throws input_error when the value is of another
/// kind.
class yaml_value {
  public:
    yaml_value(std::shared_ptr<const yaml_node> node, input_location where)
        : node_(std::move(node)), where_(std::move(where)) {}

    const input_location& where() const { return where_; }
    bool is_scalar() const;
    bool is_list() const;
    bool is_map() const;

    /// A scalar that is not empty and stands on one line. `expected` completes "expected ...".
    std::string text(std::string_view expected) const;

    /// A scalar of any number of lines, joined by spaces.
    std::string paragraph(std::string_view expected) const;

    /// The text of a finite number or of an expression; whether the expression means anything is not asked here.
    std::string expression() const;

    /// A finite number.
    double number() const;
    double positive_number() const;

    std::vector<yaml_value> items(std::string_view expected) const;

    /// Entries of a map in written order; keys are scalars and differ.
    std::vector<std::pair<std::string, yaml_value>> entries(std::string_view expected) const;

    /// Throws input_error "expected <expected>, got <what stands here>".
    [[noreturn]] void reject(std::string_view expected) const;

  private:
    std::shared_ptr<const yaml_node> node_;
    input_location where_;
};

/// The place of the entry `key` of the map at `map`.
input_location in_field(const input_location& map, const std::string& key);

/// A map whose keys are known beforehand.
class yaml_fields {
  public:
    /// Throws input_error when `map` is no map or has a key outside `allowed`; the message lists the allowed ones.
    yaml_fields(const yaml_value& map, std::initializer_list<std::string_view> allowed);

    const input_location& where() const { return where_; }

    std::optional<yaml_value> find(std::string_view key) const;

    /// Throws input_error "missing, expected <expected>".
    yaml_value require(std::string_view key, std::string_view expected) const;

  private:
    input_location where_;
    std::vector<std::pair<std::string, yaml_value>> entries_;
};

/// Reads a file that holds one YAML document. Refused with input_error: unreadable files, more than 1 MB, control
/// characters, syntax errors, more than 20 levels, aliases (a value then has no line of its own), a second document.
yaml_value read_yaml(const std::string& file);

/// The number written in the whole of `text`, if that is what it is (overflow and .nan, .inf count as numbers: the
/// result is then not finite).
std::optional<double> as_number(std::string_view text);

}  // namespace idim::generator
