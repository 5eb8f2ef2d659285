#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "backend/language.hpp"

namespace idim::generator {

namespace {

class c_language : public language {
  public:
    explicit c_language(bool single) : single_(single) {}

    std::string scalar() const override { return single_ ? "float" : "double"; }
    std::string suffix() const override { return single_ ? "_f" : ""; }
    std::set<std::string> reserved() const override {
        std::set<std::string> names;
        for (int kind = static_cast<int>(function_kind::sin); kind <= static_cast<int>(function_kind::pow); ++kind) {
            names.insert(function_name(static_cast<function_kind>(kind)));
        }
        return names;
    }

    /// The value that a C++ program gives Scalar(number): rounded to double, then to float.
    std::string number(const rational& value) const override {
        const double exact = to_double(value);
        const auto rounded = static_cast<float>(exact);
        if (single_ && std::isinf(rounded)) {
            return "INFINITY";
        }
        const std::string text = single_ ? fmt::format("{}", rounded) : fmt::format("{}", exact);
        const bool is_integer = text.find_first_of(".e") == std::string::npos;
        return text + (is_integer ? ".0" : "") + (single_ ? "f" : "");
    }
    std::string call(function_kind function, const std::string& arguments) const override {
        return fmt::format("{}({})", function_name(function), arguments);
    }
    std::string base_place(const std::string& robot, const std::string& parameter) const override {
        return robot + "_base_" + parameter;
    }
    std::string standard_place(const std::string& robot, const std::string& parameter) const override {
        return robot + "_standard_" + parameter;
    }
    std::string base_count(const std::string& robot) const override {
        std::string text = robot + "_BASE_PARAMETERS";
        std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
        return text;
    }
    std::string definition(const std::string& name, const std::string& value) const override {
        return fmt::format("const {} {} = {};", scalar(), name, value);
    }
    std::string alias(const std::string& name, const std::string& element) const override {
        return definition(name, element);
    }

    std::string signature(const std::string& robot, const std::string& function,
                          const std::vector<function_argument>& arguments) const override {
        std::vector<std::string> declarations;
        for (const function_argument& argument : arguments) {
            const char* constant = argument.is_output || argument.size == 0 ? "" : "const ";
            const std::string extent = argument.size == 0 ? "" : fmt::format("[{}]", argument.size);
            declarations.push_back(fmt::format("{}{} {}{}", constant, scalar(), argument.name, extent));
        }
        return in_lines(fmt::format("void {}(", full_name(robot, function)), declarations) + ")";
    }
    std::string invocation(const std::string& robot, const std::string& function,
                           const std::vector<function_argument>& arguments) const override {
        std::vector<std::string> names;
        for (const function_argument& argument : arguments) {
            names.push_back(argument.name);
        }
        return fmt::format("{}({});", full_name(robot, function), fmt::join(names, ", "));
    }
    std::vector<std::string> prologue(const std::set<function_kind>& /*called*/,
                                      const std::vector<function_argument>& arguments) const override {
        std::vector<std::string> lines;
        for (const function_argument& argument : arguments) {
            if (!argument.used) {
                lines.push_back(fmt::format("(void){};", argument.name));
            }
        }
        return lines;
    }

  private:
    std::string full_name(const std::string& robot, const std::string& function) const {
        return robot + "_" + function + suffix();
    }
    /// sign is a static function of the file that calls it.
    std::string function_name(function_kind function) const {
        if (function == function_kind::sign) {
            return to_string(function);
        }
        return std::string(function == function_kind::abs ? "fabs" : to_string(function)) + (single_ ? "f" : "");
    }
    static std::string in_lines(const std::string& start, const std::vector<std::string>& declarations) {
        std::string text = start;
        std::size_t width = start.size();
        for (std::size_t k = 0; k < declarations.size(); ++k) {
            const std::string separator = k == 0 ? "" : ",";
            const bool fits = k == 0 || width + declarations[k].size() + 3 <= line_width;
            text += separator + (fits ? (k == 0 ? "" : " ") : "\n" + std::string(start.size(), ' ')) + declarations[k];
            width = (fits ? width : start.size()) + declarations[k].size() + 2;
        }
        return text;
    }

    bool single_;
};

}  // namespace

languages c_languages() {
    languages all;
    all.push_back(std::make_unique<c_language>(false));
    all.push_back(std::make_unique<c_language>(true));
    return all;
}

}  // namespace idim::generator
