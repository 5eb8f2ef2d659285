#include <fmt/format.h>
#include <fmt/ranges.h>

#include "backend/language.hpp"

namespace idim::generator {

namespace {

class cpp_language : public language {
  public:
    std::string scalar() const override { return "Scalar"; }
    std::set<std::string> reserved() const override {
        return {"Scalar", "std", "base_parameters", "base_index", "standard_index"};
    }

    std::string number(const rational& value) const override { return fmt::format("Scalar({})", to_decimal(value)); }
    /// sign is ours, and a template that does not take the expressions of types that delay their arithmetic.
    std::string call(function_kind function, const std::string& arguments) const override {
        const bool delayed = function == function_kind::sign && arguments.find(' ') != std::string::npos;
        return fmt::format("{}({})", to_string(function), delayed ? fmt::format("Scalar({})", arguments) : arguments);
    }
    std::string base_place(const std::string& /*robot*/, const std::string& parameter) const override {
        return "base_index::" + parameter;
    }
    std::string standard_place(const std::string& /*robot*/, const std::string& parameter) const override {
        return "standard_index::" + parameter;
    }
    std::string base_count(const std::string& /*robot*/) const override { return "base_parameters"; }
    std::string definition(const std::string& name, const std::string& value) const override {
        return fmt::format("const Scalar {} = {};", name, value);
    }
    std::string alias(const std::string& name, const std::string& element) const override {
        return fmt::format("const Scalar& {} = {};", name, element);
    }

    std::string signature(const std::string& /*robot*/, const std::string& function,
                          const std::vector<function_argument>& arguments) const override {
        const std::string start = fmt::format("void {}(", function);
        std::vector<std::string> declarations;
        for (const function_argument& argument : arguments) {
            declarations.push_back(fmt::format("{}{}Scalar{} {}", argument.used ? "" : "[[maybe_unused]] ",
                                               argument.is_output ? "" : "const ", argument.size == 0 ? "&" : "*",
                                               argument.name));
        }
        return fmt::format("{}{})", start, fmt::join(declarations, ",\n" + std::string(start.size(), ' ')));
    }
    /// Qualified: a scalar type of another robot's namespace, its pack, would bring that robot's function in as well.
    std::string invocation(const std::string& robot, const std::string& function,
                           const std::vector<function_argument>& arguments) const override {
        std::vector<std::string> names;
        for (const function_argument& argument : arguments) {
            names.push_back(argument.name);
        }
        return fmt::format("{}::{}({});", robot, function, fmt::join(names, ", "));
    }
    /// Functions of <cmath> for the built-in types; those of other types are found by their arguments.
    std::vector<std::string> prologue(const std::set<function_kind>& called,
                                      const std::vector<function_argument>& /*arguments*/) const override {
        std::set<std::string> names;
        for (const function_kind function : called) {
            if (function != function_kind::sign) {
                names.insert(fmt::format("std::{}", to_string(function)));
            }
        }
        return names.empty() ? std::vector<std::string>{}
                             : std::vector{fmt::format("using {};", fmt::join(names, ", "))};
    }
};

}  // namespace

languages cpp_languages() {
    languages all;
    all.push_back(std::make_unique<cpp_language>());
    return all;
}

}  // namespace idim::generator
