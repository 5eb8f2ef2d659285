#pragma once

#include <optional>
#include <string>
#include <vector>

namespace idim::cli {

/// Throws input_error: OPTION: "text", expected ...
[[noreturn]] void refuse_option(const std::string& option, const std::string& text, const std::string& expected);

/// The finite number that the whole of a text is; nothing if it is none.
std::optional<double> finite_number(const std::string& text);

/// Whom "j3=..." or, without a name, all of "..." means: places in the list of names, and the text behind.
struct addressed {
    std::vector<std::size_t> places;
    std::string text;
};

/// `before` stands in front of every name and is not written. Throws input_error with all names where none is meant.
addressed address(const std::string& option, const std::string& text, const std::vector<std::string>& names,
                  const std::string& before = "");

}  // namespace idim::cli
