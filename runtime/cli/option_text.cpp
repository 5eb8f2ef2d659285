#include "option_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "description/yaml_reader.hpp"
#include "idim/input_error.hpp"

namespace idim::cli {

void refuse_option(const std::string& option, const std::string& text, const std::string& expected) {
    throw input_error({"", 0, option}, fmt::format("\"{}\", expected {}", text, expected));
}

std::optional<double> finite_number(const std::string& text) {
    const std::optional<double> value = generator::as_number(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

addressed address(const std::string& option, const std::string& text, const std::vector<std::string>& names,
                  const std::string& before) {
    addressed result;
    const std::size_t equals = text.find('=');
    result.text = equals == std::string::npos ? text : text.substr(equals + 1);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (equals == std::string::npos || names[i] == before + text.substr(0, equals)) {
            result.places.push_back(i);
        }
    }
    if (result.places.empty()) {
        refuse_option(option, text, fmt::format("one joint of: {}", fmt::join(names, ", ")));
    }
    return result;
}

}  // namespace idim::cli
