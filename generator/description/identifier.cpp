#include "description/identifier.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t longest_name = 64;

/// ISO C++20 [lex.key] and [lex.digraph], the C11 keywords without a leading underscore, and names that mean something
/// at the file level of every generated source.
constexpr std::string_view language_names =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t"
    " class compl concept const consteval constexpr constinit const_cast continue co_await co_return co_yield"
    " decltype default delete do double dynamic_cast else enum explicit export extern false float for friend"
    " goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private"
    " protected public register requires return short signed sizeof static static_assert static_cast"
    " reinterpret_cast struct switch template this thread_local throw true try typedef typeid typename union"
    " unsigned using virtual void volatile wchar_t while xor xor_eq restrict main std idim assert errno NULL"
    " EOF NAN INFINITY linux unix base ";

constexpr std::string_view expression_names =
    " q qd qdd t temp tau tau_rigid q_from qd_from qdd_from pi e i I sin cos tan asin acos atan atan2 sinh"
    " cosh tanh exp log sqrt pow abs sign min max chi W Y M N XX XY XZ YY YZ ZZ MX MY MZ ";

/// `words` holds a space before and after each of its words.
bool is_among(std::string_view words, const std::string& name) {
    return words.find(" " + name + " ") != std::string_view::npos;
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_identifier(std::string_view name) {
    return !name.empty() && name.size() <= longest_name && is_letter(name.front()) &&
           std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

/// One of the stems of a numbered quantity followed by digits, and by R where a base parameter regroups others.
bool is_numbered_quantity(std::string_view name) {
    static constexpr std::array<std::string_view, 19> stems = {"XX", "XY", "XZ",  "YY",  "YZ",  "ZZ", "MX",
                                                               "MY", "MZ", "M",   "Ia",  "Fv",  "Fc", "off",
                                                               "q",  "qd", "qdd", "tau", "temp"};
    if (!name.empty() && name.back() == 'R') {
        name.remove_suffix(1);
    }
    const auto end_of_digits = std::find_if_not(name.rbegin(), name.rend(), is_digit);
    const auto stem_size = static_cast<std::size_t>(name.rend() - end_of_digits);
    return stem_size < name.size() && std::find(stems.begin(), stems.end(), name.substr(0, stem_size)) != stems.end();
}

}  // namespace

std::string checked_name(const std::string& name, const input_location& where) {
    if (!is_identifier(name)) {
        throw input_error(where, "expected a name of letters, digits and underscores, a letter first, at most " +
                                     std::to_string(longest_name) + " long, got " + quote(name));
    }
    if (is_among(language_names, name)) {
        throw input_error(where, quote(name) + " has a meaning in generated code, expected another name");
    }
    return name;
}

std::string nearest_name(const std::string& text, char prefix, const input_location& where) {
    std::string name = text;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !is_letter(c) && !is_digit(c); }, '_');
    if (name.empty() || !is_letter(name.front())) {
        name.insert(name.begin(), prefix);
    }
    if (is_among(language_names, name)) {
        name += '_';
    }
    return checked_name(name, where);
}

std::string checked_symbol(const std::string& name, const input_location& where) {
    checked_name(name, where);
    if (is_among(expression_names, name)) {
        throw input_error(where, quote(name) + " has a meaning in expressions, expected another name");
    }
    if (is_numbered_quantity(name)) {
        throw input_error(where,
                          quote(name) + " is the name of a signal or parameter of a link, expected another name");
    }
    return name;
}

}  // namespace idim::generator
