#include "resources.hpp"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

namespace fs = std::filesystem;

std::string first_with(const std::vector<fs::path>& folders, const char* probe, const char* what) {
    for (const fs::path& folder : folders) {
        if (!folder.empty() && fs::exists(folder / probe)) {
            return folder.string();
        }
    }
    throw input_error({"", 0, ""},
                      std::string("cannot find ") + what + ", looked for " + probe + " in " + folders.back().string());
}

fs::path installed_prefix() {
    std::error_code error;
    const fs::path command = fs::read_symlink("/proc/self/exe", error);
    return error ? fs::path() : command.parent_path().parent_path();
}

}  // namespace

std::string templates_folder() {
    const char* given = std::getenv("IDIM_TEMPLATES");
    return first_with({given == nullptr ? "" : given, installed_prefix() / "share/idim/templates",
                       fs::path(IDIM_SOURCE_DIR) / "templates"},
                      "cpp/function.hpp.mustache", "the templates");
}

std::string include_folder() {
    return first_with({installed_prefix() / "include", fs::path(IDIM_SOURCE_DIR) / "runtime/include"},
                      "idim/model_interface.h", "the runtime's headers");
}

}  // namespace idim::cli
