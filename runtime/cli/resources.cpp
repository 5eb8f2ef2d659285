#include "resources.hpp"

#include <cstdlib>
#include <filesystem>

#include "description/text_file.hpp"
#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

namespace fs = std::filesystem;

/// What the command's own folder, bin/, stands in: links are followed, so a link to the command finds the same.
fs::path prefix() {
    std::error_code error;
    const fs::path command = fs::read_symlink("/proc/self/exe", error);
    return error ? fs::path() : command.parent_path().parent_path();
}

std::string folder_with(const fs::path& folder, const char* probe, const char* what) {
    if (!fs::exists(folder / probe)) {
        throw input_error({"", 0, ""},
                          std::string("cannot find ") + what + ", looked for " + probe + " in " + folder.string());
    }
    return folder.string();
}

}  // namespace

std::string templates_folder() {
    const char* given = std::getenv("IDIM_TEMPLATES");
    const bool is_given = given != nullptr && *given != '\0';
    return folder_with(is_given ? fs::path(given) : prefix() / "share/idim/templates", "cpp/function.hpp.mustache",
                       is_given ? "the templates that IDIM_TEMPLATES names" : "the templates");
}

model_source interface_header(const std::string& name) {
    constexpr std::size_t largest = 1'000'000;
    const std::string folder = folder_with(prefix() / "include", name.c_str(), "the runtime's headers");
    return {name, generator::read_text_file(folder + "/" + name, largest)};
}

}  // namespace idim::cli
