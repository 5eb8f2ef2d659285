#include "oracles/serial_regrouping.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace idim::test {

namespace {

/// YY, MZ and M of link j go to link j and to its antecedent i. `chi` holds all of both.
void regroup_link(value_table& chi, const mdh_row& row, std::size_t number) {
    const std::string j = std::to_string(number);
    const std::string i = std::to_string(number - 1);
    const double d = row.d;
    const double r = row.r;
    const double S = std::sin(row.alpha);
    const double C = std::cos(row.alpha);
    const double YY = chi["YY" + j];
    const double MZ = chi["MZ" + j];
    const double M = chi["M" + j];
    chi["XX" + j] -= YY;
    chi["XX" + i] += YY + 2 * r * MZ + r * r * M;
    chi["XY" + i] += d * S * MZ + d * r * S * M;
    chi["XZ" + i] += -d * C * MZ - d * r * C * M;
    chi["YY" + i] += C * C * YY + 2 * r * C * C * MZ + (d * d + r * r * C * C) * M;
    chi["YZ" + i] += C * S * YY + 2 * r * C * S * MZ + r * r * C * S * M;
    chi["ZZ" + i] += S * S * YY + 2 * r * S * S * MZ + (d * d + r * r * S * S) * M;
    chi["MX" + i] += d * M;
    chi["MY" + i] += -S * MZ - r * S * M;
    chi["MZ" + i] += C * MZ + r * C * M;
    chi["M" + i] += M;
}

}  // namespace

value_table regroup_serial(const mdh_table& table, value_table chi) {
    const std::size_t n = table.rows.size();
    for (const mdh_row& row : table.rows) {
        if (row.prismatic || row.gamma != 0.0 || row.b != 0.0) {
            throw std::runtime_error("the closed rules are for serial revolute chains");
        }
    }
    if (table.rows[0].alpha != 0.0 || std::abs(std::cos(table.rows[1].alpha)) > 1e-12) {
        throw std::runtime_error("the closed rules are for a vertical first and a horizontal second axis");
    }
    for (std::size_t j = n; j > 1; --j) {
        regroup_link(chi, table.rows[j - 1], j);
    }
    for (const char* joint : {"1", "2"}) {
        const auto rotor = chi.find(std::string("Ia") + joint);
        if (rotor != chi.end()) {
            chi[std::string("ZZ") + joint] += rotor->second;
            chi.erase(rotor);
        }
    }
    for (std::size_t j = 1; j <= n; ++j) {
        for (const char* dropped : {"YY", "MZ", "M"}) {
            chi.erase(dropped + std::to_string(j));
        }
    }
    for (const char* without_effect : {"XX1", "XY1", "XZ1", "YZ1", "MX1", "MY1"}) {
        chi.erase(without_effect);
    }
    return chi;
}

}  // namespace idim::test
