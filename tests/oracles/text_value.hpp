#pragma once

#include <map>
#include <string>

namespace idim::test {

/// Values of the names an expression may use.
using value_table = std::map<std::string, double>;

/// Value of a text such as "q + pi/2" or "ZZ1 + (1 - cos(a)^2)*YY2" in double precision: numbers, names, + - * / ^,
/// parentheses, sin and cos. Recursive descent over characters, without anything of the generator. Throws
/// std::runtime_error.
double text_value(const std::string& text, const value_table& names);

}  // namespace idim::test
