#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace idim::test_support {

/// Path of a file of measured data such as "emps/ident.csv.gz", or nothing if it is not there: in the directory that
/// the environment variable IDIM_DATA names, else in the one that the build gave as IDIM_SHARED_DATA. Tests without it
/// are skipped.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
    std::filesystem::path directory;
    if (const char* chosen = std::getenv("IDIM_DATA"); chosen != nullptr) {
        directory = chosen;
    } else {
#ifdef IDIM_SHARED_DATA
        directory = IDIM_SHARED_DATA;
#endif
    }
    const std::filesystem::path path = directory / name;
    std::error_code error;
    return !directory.empty() && std::filesystem::is_regular_file(path, error) ? std::optional(path) : std::nullopt;
}

}  // namespace idim::test_support

/// In a test: its path as `variable`, or the test is skipped.
#define IDIM_REQUIRE_DATA(variable, name)                                                       \
    const auto variable = idim::test_support::shared_data(name);                                \
    if (!variable) {                                                                            \
        GTEST_SKIP() << name << " is not here: set IDIM_DATA to the folder of measured robots"; \
    }
