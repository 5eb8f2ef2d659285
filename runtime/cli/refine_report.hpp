#pragma once

#include <string>

#include "traced_robot.hpp"

namespace idim::cli {

/// What refine found, for people: report.md.
struct refine_outcome {
    const traced_robot& before;
    const traced_robot& after;
    trace_errors errors_before;
    trace_errors errors_after;
    effect_trace trace;
};

std::string to_markdown(const refine_outcome& outcome);

}  // namespace idim::cli
