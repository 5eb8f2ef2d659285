#pragma once

#include <optional>
#include <string>
#include <vector>

namespace idim {

/// A file before and after a change; nothing where it does not exist.
struct file_change {
    std::string name;
    std::optional<std::string> before, after;
};

/// The changes as `diff -u` writes them: a/NAME against b/NAME, /dev/null in the place of a file that does not exist,
/// three lines of context, empty where nothing differs. `git apply` and `patch -p1` carry it out. Throws
/// std::runtime_error where there is no diff (GNU diffutils, or another that knows --label) on the PATH.
std::string unified_diff(const std::vector<file_change>& changes);

}  // namespace idim
