#include "idim/unified_diff.hpp"

#include <filesystem>
#include <stdexcept>

#include "child_process.hpp"
#include "idim/private_folder.hpp"
#include "trusted_file.hpp"

namespace idim {

// 2026-11-22: who computes the differences? Asked: our own code, libgit2 or the program diff. Our own would be a second
// version of a solved problem. libgit2 needs no temporary files, but brings TLS, SSH and Kerberos libraries into a
// command that runs in every build: 3.5 ms more at every start, measured, where all models of a robot take 50. diff is
// on every Debian (diffutils is essential) and is started only where a file differs. It gets copies of the bytes that
// were compared, so the files cannot change in between, and the C locale, in which its messages are part of the format.

namespace {

constexpr const char* no_file = "/dev/null";

std::string copied(const std::optional<std::string>& text, const std::filesystem::path& file) {
    if (!text) {
        return no_file;
    }
    write_private_file(file, *text);
    return file.string();
}

std::string label(const std::optional<std::string>& text, const std::string& side, const std::string& name) {
    return "--label=" + (text ? side + name : no_file);
}

}  // namespace

std::string unified_diff(const std::vector<file_change>& changes) {
    std::string text;
    for (const file_change& change : changes) {
        if (change.before == change.after) {
            continue;
        }
        const private_folder folder(std::filesystem::temp_directory_path() / "idim-");
        const child_result result =
            run_child({"/usr/bin/env", "LC_ALL=C", "diff", "-u", "--text", label(change.before, "a/", change.name),
                       label(change.after, "b/", change.name), copied(change.before, folder.path() / "before"),
                       copied(change.after, folder.path() / "after")});
        if (result.exit_status > 1) {
            throw std::runtime_error("diff, which shows the changes, failed: " + result.output);
        }
        text += result.output;
    }
    return text;
}

}  // namespace idim
