#pragma once

#include <string>

namespace idim::test {

/// The description of one mass on a rail, without gravity.
inline std::string rail_text(const std::string& effects) {
    return "name: rail\n"
           "gravity: [0, 0, 0]\n"
           "joints:\n"
           "  - {name: slide, type: prismatic, r: q}\n"
           "effects: [" +
           effects + "]\n";
}

}  // namespace idim::test
