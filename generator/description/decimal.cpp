#include "description/decimal.hpp"

#include <boost/math/constants/constants.hpp>
#include <charconv>
#include <cmath>

#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

const decimal quarter = boost::math::constants::half_pi<decimal>();
constexpr int most_quarter_turns = 8;
constexpr int most_decimals = 30;

std::string shortest_text(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

/// Number of decimals behind the point of a written number, without zeros at the end: 4 for "-1.5708" and "15.7080e-1".
int decimals_of(const std::string& text) {
    const std::size_t exponent_at = text.find_first_of("eE");
    const std::string mantissa = text.substr(0, exponent_at);
    const std::size_t point = mantissa.find('.');
    int decimals = 0;
    if (point != std::string::npos) {
        decimals = static_cast<int>(mantissa.find_last_not_of('0')) - static_cast<int>(point);
    }
    int exponent = 0;
    if (exponent_at != std::string::npos) {
        const char* first = text.data() + exponent_at + 1;
        std::from_chars(*first == '+' ? first + 1 : first, text.data() + text.size(), exponent);
    }
    return decimals - exponent;
}

/// Whether `value`, which has so many decimals, is `exact` rounded or cut off to them. Both positive.
bool is_shortened(const decimal& value, const decimal& exact, int decimals) {
    const decimal scale = pow(decimal(10), decimals);
    const decimal shifted = exact * scale;
    const decimal digits = round(value * scale);
    return digits == trunc(shifted) || digits == round(shifted);
}

}  // namespace

decimal decimal_of(double value) {
    return decimal(shortest_text(value));
}

double nearest_double(const decimal& value) {
    static const decimal rounding("1e-30");
    if (abs(value) < rounding) {
        return 0.0;
    }
    const std::string text = value.str(40, std::ios::scientific);
    double result = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), result);
    return result;
}

std::string length_text(const decimal& length) {
    return abs(length) < geometric_tolerance ? "0" : shortest_text(nearest_double(length));
}

std::string angle_text(const decimal& angle) {
    const decimal turn = 4 * quarter;
    const decimal within = angle - turn * ceil(angle / turn - decimal("0.5") - geometric_tolerance);
    const decimal quarters = round(within / quarter);
    if (abs(within - quarters * quarter) >= geometric_tolerance) {
        return shortest_text(nearest_double(within));
    }
    static const char* const texts[] = {"-pi/2", "0", "pi/2", "pi"};
    return texts[static_cast<int>(quarters) + 1];
}

written_angle::written_angle(const std::string& text, int fewest_decimals)
    : radians(decimal_of(as_number(text).value_or(0.0))) {
    const decimal magnitude = abs(radians);
    const decimal turns = round(magnitude / quarter);
    const int decimals = decimals_of(text);
    if (decimals < fewest_decimals || decimals > most_decimals || turns < 1 || turns > most_quarter_turns ||
        !is_shortened(magnitude, turns * quarter, decimals)) {
        return;
    }
    quarter_turns = radians < 0 ? -static_cast<int>(turns) : static_cast<int>(turns);
    radians = quarter_turns * quarter;
}

written_angle angle_of(double radians) {
    return written_angle(shortest_text(radians));
}

unit_vector written_angle::direction() const {
    if (quarter_turns == 0) {
        return {cos(radians), sin(radians)};
    }
    static const unit_vector directions[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    return directions[((quarter_turns % 4) + 4) % 4];
}

}  // namespace idim::generator
