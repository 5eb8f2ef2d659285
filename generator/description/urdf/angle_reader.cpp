#include "description/urdf/angle_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "description/decimal.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr double double_precision = 1e-12;
constexpr int decimals_of_a_hint = 2;

std::string quarter_text(int turns) {
    const int magnitude = std::abs(turns);
    const int numerator = magnitude % 2 == 0 ? magnitude / 2 : magnitude;
    return (turns < 0 ? "-" : "") + (numerator == 1 ? "" : std::to_string(numerator) + "*") +
           (magnitude % 2 == 0 ? "pi" : "pi/2");
}

}  // namespace

double angle_reader::read(const std::string& text, const input_location& where) {
    const std::optional<double> number = as_number(text);
    if (!number || !std::isfinite(*number)) {
        throw input_error(where, "expected a finite angle, got " + quote(text));
    }
    const written_angle angle(text);
    const double radians = nearest_double(angle.radians);
    if (angle.quarter_turns == 0 && written_angle(text, decimals_of_a_hint).quarter_turns != 0) {
        note(nearly_, text, where.line);
    } else if (std::abs(radians - *number) > double_precision) {
        note(rounded_, text + " as " + quarter_text(angle.quarter_turns), where.line);
    }
    return radians;
}

std::vector<std::string> angle_reader::notes() const {
    std::vector<std::string> result;
    if (!rounded_.empty()) {
        result.push_back("angles read as multiples of pi/2: " + listed(rounded_));
    }
    if (!nearly_.empty()) {
        result.push_back("angles with too few decimals to be a multiple of pi/2, read as written: " + listed(nearly_));
    }
    return result;
}

void angle_reader::note(lines_of& list, const std::string& text, int line) {
    auto entry = std::find_if(list.begin(), list.end(), [&text](const auto& known) { return known.first == text; });
    if (entry == list.end()) {
        entry = list.insert(list.end(), {text, {}});
    }
    if (entry->second.empty() || entry->second.back() != line) {
        entry->second.push_back(line);
    }
}

std::string angle_reader::listed(const lines_of& list) {
    std::string text;
    for (const auto& [angle, lines] : list) {
        std::string numbers;
        for (const int line : lines) {
            numbers += (numbers.empty() ? "" : ", ") + std::to_string(line);
        }
        text += (text.empty() ? "" : "; ") + angle + (lines.size() == 1 ? " (line " : " (lines ") + numbers + ")";
    }
    return text;
}

}  // namespace idim::generator
