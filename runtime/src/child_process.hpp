#pragma once

#include <string>
#include <vector>

namespace idim {

/// How a child process ended and what it wrote.
struct child_result {
    int exit_status = 0;  ///< as a shell gives it: 128 + n where signal n ended the process
    std::string output;   ///< standard output and standard error
};

/// Runs `command`, its first word the program's path, without a shell and with nothing to read, and waits for it.
/// Throws std::runtime_error if it cannot be started.
child_result run_child(const std::vector<std::string>& command);

}  // namespace idim
