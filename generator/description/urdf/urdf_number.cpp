#include "description/urdf/urdf_number.hpp"

#include <cmath>
#include <string>

namespace idim::generator {

double bounded(double value, const input_location& where) {
    constexpr double largest = 1e9;
    if (std::abs(value) > largest) {
        throw input_error(where, "a number beyond 1e9, expected SI units");
    }
    return value;
}

double not_negative(double value, const input_location& where, const char* what) {
    if (value < 0.0) {
        throw input_error(where, std::string("negative ") + what + ", expected zero or more");
    }
    return bounded(value, where);
}

}  // namespace idim::generator
