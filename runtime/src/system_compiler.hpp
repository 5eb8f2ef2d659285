#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace idim {

/// A C++ compiler of this machine that understands the options of g++ and clang++.
struct system_compiler {
    std::vector<std::string> command;  ///< absolute path of the program and its own arguments, then the flags
    /// What it answers to --version, and the macros that tell the instruction set it compiles for.
    std::string version;
};

/// The compiler of that name, else the one in $CXX, else the first of c++, g++, clang++ on the PATH. A name that is no
/// program as a whole is split at blanks into a program and its arguments, such as "ccache g++".
/// Compiles for this machine's processor where the compiler can.
/// Throws std::runtime_error if there is none or it does not answer to --version.
system_compiler find_compiler(const std::string& name);

/// What a shared object is made from.
struct library_files {
    std::filesystem::path include;               ///< folder of the headers
    std::vector<std::filesystem::path> sources;  ///< .cpp files
    std::filesystem::path exports;               ///< version script of the linker: the symbols seen from outside
    std::filesystem::path library;               ///< the shared object to write
};

/// Throws std::runtime_error with the first lines of the compiler's message and the command if it fails.
void compile_library(const system_compiler& compiler, const library_files& files);

}  // namespace idim
