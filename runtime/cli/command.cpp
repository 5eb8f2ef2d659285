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
    // A file that is quoted may hold bytes that are no UTF-8; JSON may not.
    const std::string text = ordered.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    if (file == "-") {
        fmt::print("{}", text);
        return;
    }
    // A device or pipe is written into: a file renamed over /dev/null would take its place.
    std::error_code error;
    const bool is_special = std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
    const std::string written = is_special ? file : file + ".tmp";
    std::ofstream out(written, std::ios::binary);
    out << text;
    out.close();
    error.clear();
    if (out && !is_special) {
        std::filesystem::rename(written, file, error);
    }
    if (!out || error) {
        if (!is_special) {
            std::filesystem::remove(written, error);
        }
        throw input_error({file, 0, "--json"}, "cannot be written");
    }
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        throw input_error({file.string(), 0, ""}, "cannot be written");
    }
}

}  // namespace idim::cli
