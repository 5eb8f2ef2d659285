#include "graph/rational.hpp"

#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational_io.h>
#include <fmt/format.h>

#include <sstream>

namespace idim::generator {

double to_double(const rational& value) {
    return cln::double_approx(value);
}

std::string to_decimal(const rational& value) {
    return fmt::format("{}", to_double(value));
}

std::string to_fraction(const rational& value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

}  // namespace idim::generator
