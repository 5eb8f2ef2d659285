#pragma once

#include <Eigen/Core>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <string>

namespace idim::generator {

/// A number of 50 decimal digits. Geometry that a file gives in decimals is composed in these: decimals stay what they
/// are, and what is rounded to a double at the end is the same on every machine, whatever its floating point and its
/// mathematical library do in their last digit.
using decimal = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<50>, boost::multiprecision::et_off>;
using decimal_vector = Eigen::Matrix<decimal, 3, 1>;
using decimal_matrix = Eigen::Matrix<decimal, 3, 3>;

/// Two directions that differ by less [rad] are parallel, two points that differ by less [m] are one.
inline const decimal geometric_tolerance("1e-9");

/// The decimal number that a double stands for: the shortest text that reads back as `value`.
decimal decimal_of(double value);

/// Nearest double; what is below 1e-30 comes from rounding and is zero.
double nearest_double(const decimal& value);

/// Shortest text that reads back as the nearest double; "0" within the tolerance of zero.
std::string length_text(const decimal& length);

/// The angle in (-pi, pi]; within the tolerance of a multiple of pi/2 as that multiple: "0", "pi/2", "-pi/2", "pi".
std::string angle_text(const decimal& angle);

/// Cosine and sine; exact for multiples of pi/2.
struct unit_vector {
    decimal cos = 1;
    decimal sin = 0;
};

/// An angle as a file writes it.
struct written_angle {
    decimal radians;
    int quarter_turns = 0;  ///< if it was read as this multiple of pi/2

    /// `text` is a number. It is k*pi/2, |k| from 1 to 8, if that is what rounding or cutting off k*pi/2 to the
    /// decimals written (without zeros at the end) gives, at least `fewest_decimals` of them.
    explicit written_angle(const std::string& text, int fewest_decimals = 4);

    unit_vector direction() const;
};

/// The angle that a double stands for [rad].
written_angle angle_of(double radians);

}  // namespace idim::generator
