#pragma once

#include "traced_robot.hpp"

namespace idim::cli {

/// The steps in a refine.json, with which refine goes on. Throws input_error where the file cannot be read, is of
/// another robot or of rows of another band (so of other logs, or of another filter).
std::vector<trace_step> read_steps(const std::string& file, const traced_robot& traced);

}  // namespace idim::cli
