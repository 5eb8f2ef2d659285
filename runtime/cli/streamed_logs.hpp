#pragma once

#include <string>
#include <vector>

#include "identification.hpp"
#include "method_run.hpp"

namespace idim::cli {

/// Whether logs are so large that they are better read in parts: together more than 256 MiB, or compressed 64 MiB.
bool are_large(const std::vector<std::string>& files);

/// Why logs cannot be read in parts, one phrase; empty where they can: by ols and wls of models without a
/// whole_log_need, and by cwls too where periods are averaged.
std::string streaming_obstacle(const loaded_robot& robot, const std::string& method, bool averages);

/// An identification without its rows, and what the method made of them.
struct streamed_outcome {
    identification found;
    method_result by;
};

/// ols or wls of logs that are read in parts.
streamed_outcome identify_streamed(const loaded_robot& robot, const std::vector<stored_log>& logs,
                                   const filter_choice& filter, const std::string& method);

}  // namespace idim::cli
