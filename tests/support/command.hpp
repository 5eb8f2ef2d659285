#pragma once

#include <string>
#include <vector>

#include "support/robot_files.hpp"

namespace idim::test {

struct command_result {
    int status = -1;  ///< exit status; -1 if a signal ended it
    std::string out, err;
};

/// Runs a program, looked for on the PATH, and waits for its end.
command_result run_program(std::vector<std::string> words);

/// Runs the command `idim` that this build made, in a fresh process.
command_result run_idim(const std::vector<std::string>& arguments);

}  // namespace idim::test
