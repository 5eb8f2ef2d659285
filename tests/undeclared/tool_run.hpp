#pragma once

#include <string>

#include "undeclared/bench_case.hpp"
#include "undeclared/finding.hpp"

namespace idim::undeclared {

/// The command under test.
struct tool {
    std::string command;      ///< path of idim
    double time_limit = 300;  ///< for one case [s]
    std::string options;      ///< passed on to refine
};

/// Runs `idim refine` in a folder that holds a case.
finding run_refine(const tool& under_test, const bench_case& made, const std::string& folder);

/// The error on validation of a model that has the right effect, at its true size: what `idim identify` and `idim
/// validate` find on the twins of the logs, from which the effect is taken out and in which all else is the same, on
/// the rows that refine says it judged by. Throws std::runtime_error with the tool's message where it cannot.
model_errors true_model_errors(const tool& under_test, const bench_case& made, const std::string& folder);

}  // namespace idim::undeclared
