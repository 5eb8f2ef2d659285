#include "command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "idim/input_error.hpp"

namespace idim::cli {

void add_json_option(CLI::App& command, std::string& file) {
    command.add_option("--json", file, "write the result as JSON to this file, - for standard output");
}

void print_notes(const std::string& file, const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        fmt::print(stderr, "idim: {}: note: {}\n", file, note);
    }
}

bool prints_text(const std::string& json_file) {
    return json_file != "-";
}

void write_json(const std::string& file, const json& content) {
    if (file.empty()) {
        return;
    }
    json ordered = {{"idim_version", IDIM_VERSION}};
    ordered.update(content);
    const std::string text = ordered.dump(2) + "\n";
    if (file == "-") {
        fmt::print("{}", text);
        return;
    }
    const std::string temporary = file + ".tmp";
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    std::error_code error;
    if (out) {
        std::filesystem::rename(temporary, file, error);
    }
    if (!out || error) {
        std::filesystem::remove(temporary, error);
        throw input_error({file, 0, "--json"}, "cannot be written");
    }
}

}  // namespace idim::cli
