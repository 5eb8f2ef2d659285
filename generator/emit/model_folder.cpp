#include "emit/model_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return std::nullopt;
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void replace_file(const fs::path& path, const std::string& text) {
    const fs::path temporary = path.string() + "." + std::to_string(getpid()) + ".tmp";
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    std::error_code error;
    if (!file) {
        fs::remove(temporary, error);
        throw input_error({path.string(), 0, ""}, "cannot be written");
    }
    fs::rename(temporary, path);
}

/// Files that an earlier run wrote and this one does not.
std::vector<std::string> left_over(const std::vector<rendered_file>& files, const fs::path& folder) {
    std::vector<std::string> result;
    const auto text = read_file(folder / "manifest.json");
    const auto manifest = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    if (!manifest.is_object() || !manifest.contains("files") || !manifest["files"].is_array()) {
        return result;
    }
    for (const auto& entry : manifest["files"]) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : "";
        const bool still =
            std::any_of(files.begin(), files.end(), [&](const rendered_file& f) { return f.name == name; });
        const bool is_plain = !name.empty() && fs::path(name).filename() == fs::path(name);
        if (is_plain && !still && fs::is_regular_file(folder / name)) {
            result.push_back(name);
        }
    }
    return result;
}

}  // namespace

std::vector<std::string> write_model(const std::vector<rendered_file>& files, const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder)) {
        throw input_error({folder, 0, ""}, "cannot be made a folder");
    }
    std::vector<std::string> changed = left_over(files, folder);
    for (const std::string& name : changed) {
        fs::remove(fs::path(folder) / name);
    }
    for (const rendered_file& file : files) {
        const fs::path path = fs::path(folder) / file.name;
        if (read_file(path) != file.text) {
            replace_file(path, file.text);
            changed.push_back(file.name);
        }
    }
    return changed;
}

std::vector<std::string> compare_model(const std::vector<rendered_file>& files, const std::string& folder) {
    std::vector<std::string> differences;
    for (const rendered_file& file : files) {
        const auto present = read_file(fs::path(folder) / file.name);
        if (present != file.text) {
            differences.push_back(file.name + (present ? ": differs" : ": missing"));
        }
    }
    for (const std::string& name : left_over(files, folder)) {
        differences.push_back(name + ": left over");
    }
    return differences;
}

}  // namespace idim::generator
