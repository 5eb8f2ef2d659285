#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace idim::test {

inline const std::string source_folder = IDIM_SOURCE_DIR;
inline const std::string templates_folder = source_folder + "/templates";

inline std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw std::runtime_error("cannot read " + path.string());
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline std::string robot_file(const std::string& robot) {
    return source_folder + "/robots/" + robot + "/" + robot + ".yaml";
}

/// Two joints with an effect that calls every function an expression may call; depends on time and temperatures.
inline const std::string effects_arm_file = source_folder + "/tests/support/effects_arm/effects_arm.yaml";

/// Every folder in a folder of the sources, in alphabetical order.
inline std::vector<std::string> folders_in(const std::string& parent) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder + "/" + parent)) {
        if (entry.is_directory()) {
            names.push_back(entry.path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

inline std::vector<std::string> robot_names() {
    return folders_in("robots");
}

/// Those without closed loops.
inline std::vector<std::string> open_robot_names() {
    std::vector<std::string> names = robot_names();
    names.erase(std::remove_if(names.begin(), names.end(),
                               [](const std::string& robot) {
                                   return read_text(robot_file(robot)).find("\nloops:") != std::string::npos;
                               }),
                names.end());
    return names;
}

/// `text` with the one place where `from` stands changed.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
        throw std::runtime_error("\"" + from + "\" does not stand in the text once");
    }
    return text.replace(at, from.size(), to);
}

/// Text of a robot's description with other effects: `effects` is what stands behind "effects:".
inline std::string with_effects(const std::string& robot, const std::string& effects) {
    std::istringstream lines(read_text(robot_file(robot)));
    std::string text;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        inside = line.rfind("effects:", 0) == 0 || (inside && line.rfind("  ", 0) == 0);
        text += inside ? "" : line + "\n";
    }
    return text + "effects: " + effects + "\n";
}

/// Writes such a variant to `folder` and returns its path.
inline std::string write_variant(const temporary_folder& folder, const std::string& robot, const std::string& effects) {
    return folder.write(robot + ".yaml", with_effects(robot, effects));
}

}  // namespace idim::test
