#pragma once

#include <string>
#include <vector>

#include "undeclared/arm.hpp"

namespace idim::undeclared {

/// Which of the simple effects a description declares, joint by joint.
struct declaration {
    std::vector<bool> rotor, viscous, coulomb, offset;
};

/// Rotors and friction of every joint, offsets of every joint or of none.
declaration usual_declaration(const arm& robot, bool offsets);

/// The robot description as idim reads it: geometry with limits and these effects, and no dynamic parameter.
std::string description_text(const arm& robot, const declaration& declared);

}  // namespace idim::undeclared
