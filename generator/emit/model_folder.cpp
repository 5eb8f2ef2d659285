#include "emit/model_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "emit/manifest_file.hpp"
#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_generated_file = 64U << 20U;

/// Nothing where there is no regular file: a pipe of that name would never end.
std::optional<std::string> read_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        return std::nullopt;
    }
    std::ifstream file(path, std::ios::binary);
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

/// A name a generated file may have: letters, digits and underscores with an ending, nothing that leads elsewhere.
bool is_plain(const std::string& name) {
    const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-'; };
    return !name.empty() && std::isalnum(static_cast<unsigned char>(name.front())) != 0 &&
           std::all_of(name.begin(), name.end(), allowed);
}

/// Files that an earlier run wrote and this one does not.
std::vector<std::string> left_over(const std::vector<rendered_file>& files, const fs::path& folder) {
    std::vector<std::string> result;
    const auto text = read_file(folder / manifest_name);
    const auto manifest = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    if (!manifest.is_object() || !manifest.contains("files") || !manifest["files"].is_array()) {
        return result;
    }
    for (const auto& entry : manifest["files"]) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : "";
        const bool still =
            std::any_of(files.begin(), files.end(), [&](const rendered_file& f) { return f.name == name; });
        if (is_plain(name) && !still && fs::is_regular_file(folder / name)) {
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

std::string folder_difference::state() const {
    return !wanted ? "left over" : present ? "differs" : "missing";
}

std::vector<folder_difference> compare_model(const std::vector<rendered_file>& files, const std::string& folder) {
    std::vector<folder_difference> differences;
    for (const rendered_file& file : files) {
        const auto present = read_file(fs::path(folder) / file.name);
        if (present != file.text) {
            differences.push_back({file.name, present, file.text});
        }
    }
    for (const std::string& name : left_over(files, folder)) {
        differences.push_back({name, read_file(fs::path(folder) / name), std::nullopt});
    }
    return differences;
}

model_folder read_model(const std::string& folder) {
    const std::string manifest_path = (fs::path(folder) / manifest_name).string();
    const auto text = read_file(manifest_path);
    if (!text) {
        throw input_error({manifest_path, 0, ""}, "missing, expected a folder that idim generate wrote");
    }
    model_folder result{read_manifest(*text, manifest_path), {}};
    for (const std::string& name : result.content.files) {
        if (!is_plain(name)) {
            throw input_error({manifest_path, 0, "files"}, "expected plain file names");
        }
        const fs::path path = fs::path(folder) / name;
        std::error_code error;
        if (fs::is_regular_file(path, error) && fs::file_size(path, error) > largest_generated_file) {
            throw input_error({path.string(), 0, ""}, "more than 64 MiB: no generated file");
        }
        const auto content = read_file(path);
        if (!content) {
            throw input_error({path.string(), 0, ""}, "missing, though manifest.json lists it: regenerate the folder");
        }
        result.files.push_back({name, *content});
    }
    return result;
}

}  // namespace idim::generator
