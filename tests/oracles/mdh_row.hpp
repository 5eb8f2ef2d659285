#pragma once

#include <array>
#include <string>
#include <vector>

#include "description/robot_description.hpp"
#include "oracles/text_value.hpp"

namespace idim::test {

/// One modified Denavit-Hartenberg row in numbers; a driven joint adds rate*q to theta or r.
struct mdh_row {
    double gamma = 0.0, b = 0.0, alpha = 0.0, d = 0.0, theta = 0.0, r = 0.0;
    double rate = 1.0;
    bool prismatic = false;
};

struct mdh_table {
    std::array<double, 3> gravity = {0.0, 0.0, 0.0};
    value_table constants;
    std::vector<mdh_row> rows;
};

/// The numbers of a serial chain without fixed joints, from the texts of a description alone. Throws std::runtime_error
/// for other structures.
mdh_table mdh_table_of(const generator::robot_description& robot);

}  // namespace idim::test
