#include "system_compiler.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "child_process.hpp"

namespace idim {

namespace {

// A model rounds alike on every processor: no contraction into fused operations, nor the pairing of statements in which
// gcc 12 fuses all the same (vfmaddsub in the regressor of a 6R).
const std::vector<std::string> compiler_flags = {
    "-std=c++17", "-O2",    "-ffp-contract=off", "-fno-tree-slp-vectorize", "-fPIC", "-shared", "-Wall",
    "-Wextra",    "-Werror"};
// A compiled model never leaves the machine, so it may use all instructions of its processor.
constexpr const char* native = "-march=native";
constexpr int shown_lines = 20;

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::vector<std::string> split_at_blanks(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    return words;
}

bool is_program(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

/// The path keeps its links, by whose names programs such as ccache tell what to do.
std::optional<std::string> find_program(const std::string& name) {
    if (name.empty()) {
        return std::nullopt;
    }
    if (name.find('/') != std::string::npos) {
        return is_program(name) ? std::optional(std::filesystem::absolute(name).string()) : std::nullopt;
    }
    std::istringstream folders(environment("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
        if (is_program(file)) {
            return std::filesystem::absolute(file).string();
        }
    }
    return std::nullopt;
}

/// Program and arguments that a text such as "ccache g++" names.
std::vector<std::string> parse_compiler(const std::string& text, const std::string& origin) {
    if (const std::optional<std::string> whole = find_program(text)) {
        return {*whole};
    }
    std::vector<std::string> words = split_at_blanks(text);
    const std::optional<std::string> program = find_program(words.front());
    if (!program) {
        throw std::runtime_error(fmt::format("there is no compiler '{}', which {} names", words.front(), origin));
    }
    words.front() = *program;
    return words;
}

std::vector<std::string> choose_compiler(const std::string& name) {
    if (!split_at_blanks(name).empty()) {
        return parse_compiler(name, "the option for the compiler");
    }
    const std::string variable = environment("CXX");
    if (!split_at_blanks(variable).empty()) {
        return parse_compiler(variable, "the environment variable CXX");
    }
    for (const char* const usual : {"c++", "g++", "clang++"}) {
        if (const std::optional<std::string> program = find_program(usual)) {
            return {*program};
        }
    }
    throw std::runtime_error(
        "no C++ compiler: none of c++, g++, clang++ is on the PATH; install one or name it in the environment variable "
        "CXX");
}

std::string first_lines(const std::string& text) {
    std::istringstream stream(text);
    std::string shown;
    int lines = 0;
    for (std::string line; std::getline(stream, line); ++lines) {
        if (lines < shown_lines) {
            shown += "  " + line + "\n";
        }
    }
    return lines > shown_lines ? shown + fmt::format("  ... {} more lines\n", lines - shown_lines) : shown;
}

/// The macros that a compiler defines for this machine's processor: its instruction set.
child_result native_macros(std::vector<std::string> command) {
    command.insert(command.end(), {native, "-dM", "-E", "-x", "c++", "/dev/null"});
    return run_child(command);
}

}  // namespace

system_compiler find_compiler(const std::string& name) {
    system_compiler compiler;
    compiler.command = choose_compiler(name);
    std::vector<std::string> question = compiler.command;
    question.emplace_back("--version");
    const child_result answer = run_child(question);
    if (answer.exit_status != 0) {
        throw std::runtime_error(fmt::format("{} is not a compiler: exit status {}\n{}", fmt::join(question, " "),
                                             answer.exit_status, first_lines(answer.output)));
    }
    compiler.version = answer.output;
    const child_result macros = native_macros(compiler.command);
    compiler.command.insert(compiler.command.end(), compiler_flags.begin(), compiler_flags.end());
    if (macros.exit_status == 0) {
        compiler.command.emplace_back(native);
        compiler.version += macros.output;
    }
    return compiler;
}

void compile_library(const system_compiler& compiler, const library_files& files) {
    std::vector<std::string> command = compiler.command;
    command.push_back("-I" + files.include.string());
    command.emplace_back("-Xlinker");
    command.push_back("--version-script=" + files.exports.string());
    command.emplace_back("-o");
    command.push_back(files.library.string());
    for (const std::filesystem::path& source : files.sources) {
        command.push_back(source.string());
    }
    const child_result result = run_child(command);
    if (result.exit_status != 0) {
        throw std::runtime_error(fmt::format("the model does not compile, exit status {}:\n{}command: {}",
                                             result.exit_status, first_lines(result.output), fmt::join(command, " ")));
    }
    if (!std::filesystem::exists(files.library)) {
        throw std::runtime_error(
            fmt::format("the compiler wrote no {}: {}", files.library.filename().string(), fmt::join(command, " ")));
    }
}

}  // namespace idim
