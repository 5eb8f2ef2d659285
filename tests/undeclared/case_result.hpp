#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "undeclared/score.hpp"
#include "undeclared/tool_run.hpp"

namespace idim::undeclared {

/// One case from its making to its score, without the logs.
struct case_result {
    bench_case made;
    finding found;
    std::optional<model_errors> true_model;
    score scored;
    std::string problem;  ///< why there is no score, where the bench itself could not make one
};

/// Makes the case in `folder` (which exists and stays), runs the tool on it and scores what it says.
case_result run_case(const tool& under_test, const std::string& class_name, std::uint64_t seed,
                     const std::string& folder);

/// One line, enough to run the case again.
std::string line_of(const case_result& result);
nlohmann::json json_of(const case_result& result);

}  // namespace idim::undeclared
