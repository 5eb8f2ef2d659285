#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

inline constexpr std::size_t line_width = 116;  ///< of generated text

/// One argument of a generated function, before it is spelled.
struct function_argument {
    std::string name;     ///< "q"
    int size = 0;         ///< elements of the array; 0 for a single scalar
    std::string meaning;  ///< "q [2] joint positions [rad or m]"
    bool is_output = false;
    bool used = true;  ///< the body reads or writes it
};

/// What the elements of chi, of `standard` and of the rows of W are called: code places them by name, so that one
/// parameter more changes no line of the others.
struct element_names {
    std::string robot;
    std::vector<std::string> base, standard;
};

/// How a language spells what functions are made of, over one scalar type: with the templates in the folder of its
/// name, all that is known of it. The defaults are those of C and its kin. Arithmetic (+ - * / and parentheses) and
/// the order of statements are the body printer's.
class language {
  public:
    virtual ~language() = default;

    /// The scalar type: "Scalar", "float".
    virtual std::string scalar() const = 0;
    /// Ends the names of functions and files, where a target has the same functions over several scalar types.
    virtual std::string suffix() const { return ""; }
    /// Names that a body must not use for its own variables, besides those of arguments and functions.
    virtual std::set<std::string> reserved() const = 0;

    virtual std::string number(const rational& value) const = 0;
    virtual std::string call(function_kind function, const std::string& arguments) const = 0;
    /// By name where the element has one, otherwise by number.
    std::string element(const element_names& names, const std::string& array, int index) const;
    /// The constants that name places in chi and `standard`, and the number of base parameters.
    virtual std::string base_place(const std::string& robot, const std::string& parameter) const = 0;
    virtual std::string standard_place(const std::string& robot, const std::string& parameter) const = 0;
    virtual std::string base_count(const std::string& robot) const = 0;
    /// A variable that is assigned once.
    virtual std::string definition(const std::string& name, const std::string& value) const = 0;
    /// A name for an element of an argument.
    virtual std::string alias(const std::string& name, const std::string& element) const = 0;
    virtual std::string assignment(const std::string& element, const std::string& value) const;
    /// An array of scalars whose elements are assigned later.
    virtual std::string local_array(const std::string& name, int size) const;

    /// Declares a function, up to what ends a declaration or opens a body.
    virtual std::string signature(const std::string& robot, const std::string& function,
                                  const std::vector<function_argument>& arguments) const = 0;
    /// A statement that calls a generated function with arguments of its parameters' names.
    virtual std::string invocation(const std::string& robot, const std::string& function,
                                   const std::vector<function_argument>& arguments) const = 0;
    /// Statements before all others.
    virtual std::vector<std::string> prologue(const std::set<function_kind>& called,
                                              const std::vector<function_argument>& arguments) const = 0;
};

/// What a target writes its functions in, one for each scalar type.
using languages = std::vector<std::unique_ptr<const language>>;

/// C++: templates over `Scalar`, in a namespace of the robot's name.
languages cpp_languages();

/// C99: functions over double and, with suffix _f, over float; the robot's name in front of all names.
languages c_languages();

/// Names of all targets, the default first; each also names its folder of templates.
const std::vector<std::string>& target_names();

/// Throws std::invalid_argument for a name that is none of target_names().
languages languages_of(const std::string& target);

}  // namespace idim::generator
