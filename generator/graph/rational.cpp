#include "graph/rational.hpp"

#include <cln/integer.h>
#include <cln/integer_io.h>
#include <fmt/format.h>

#include <sstream>

namespace idim::generator {

namespace {

std::string text(const cln::cl_I& value) {
    if (cln::integer_length(value) < 63) {
        return std::to_string(cln::cl_I_to_long(value));
    }
    std::ostringstream stream;
    stream << value;
    return stream.str();
}

}  // namespace

double to_double(const rational& value) {
    return cln::double_approx(value);
}

std::string to_decimal(const rational& value) {
    return fmt::format("{}", to_double(value));
}

std::string to_fraction(const rational& value) {
    const cln::cl_I numerator = cln::numerator(value);
    const cln::cl_I denominator = cln::denominator(value);
    return denominator == 1 ? text(numerator) : text(numerator) + "/" + text(denominator);
}

}  // namespace idim::generator
