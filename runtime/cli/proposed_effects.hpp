#pragma once

#include <string>
#include <vector>

#include "traced_robot.hpp"

namespace idim::cli {

/// An effect file of idim's own for structure that no known effect fits.
struct proposed_effect {
    std::size_t structure = 0;  ///< its place in effect_trace::unexplained
    effect_place place;
    std::string file;
    std::string torque;  ///< expression
};

/// Writes `folder`/proposed_1.yaml .. for the structures that have terms; names of files beside the description are
/// passed over. Throws input_error where one cannot be written.
std::vector<proposed_effect> write_proposed_effects(const effect_trace& trace, const traced_robot& traced,
                                                    const std::string& robot_file, const std::string& folder);

}  // namespace idim::cli
