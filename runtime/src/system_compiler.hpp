#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace idim {

/// A C++ compiler of this machine that understands the options of g++ and clang++.
struct system_compiler {
    std::vector<std::string> command;  ///< absolute path of the program and its own arguments, then the flags
    std::string version;               ///< what it answers to --version
};

/// The compiler of that name, else the one in $CXX, else the first of c++, g++, clang++ on the PATH. A name that is no
/// program as a whole is split at blanks into a program and its arguments, such as "ccache g++".
/// Throws std::runtime_error if there is none or it does not answer to --version.
system_compiler find_compiler(const std::string& name);

/// Compiles `files` into the shared object `output`, headers looked up in `include`.
/// Throws std::runtime_error with the first lines of the compiler's message and the command if it fails.
void compile_library(const system_compiler& compiler, const std::filesystem::path& include,
                     const std::vector<std::filesystem::path>& files, const std::filesystem::path& output);

}  // namespace idim
