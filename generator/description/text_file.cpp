#include "description/text_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t megabyte = 1'000'000;

bool is_refused(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 || byte == 0x7f) && c != '\t' && c != '\n' && c != '\r';
}

/// yaml-cpp takes the byte 0x04 for the end of the file and would drop what follows in silence.
void refuse_control_characters(const std::string& text, const std::string& file) {
    const auto bad = std::find_if(text.begin(), text.end(), is_refused);
    if (bad != text.end()) {
        const int line = 1 + static_cast<int>(std::count(text.begin(), bad, '\n'));
        throw input_error({file, line, ""}, "control character " + quote(std::string(1, *bad)) + ", expected text");
    }
}

/// Piece by piece: memory for the largest file that there may be would be cleared for every small one.
std::string read_at_most(std::istream& stream, std::size_t most) {
    std::array<char, 16384> piece{};
    std::string text;
    while (stream && text.size() < most) {
        stream.read(piece.data(), static_cast<std::streamsize>(std::min(piece.size(), most - text.size())));
        text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    }
    return text;
}

}  // namespace

std::string read_text_file(const std::string& file, std::size_t largest) {
    const input_location whole_file{file, 0, ""};
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) {
        throw input_error(whole_file, "is a folder, expected a file");
    }
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw input_error(whole_file, "cannot be read: " + std::generic_category().message(errno));
    }
    const std::string text = read_at_most(stream, largest + 1);
    if (text.size() > largest) {
        throw input_error(whole_file, "is larger than " + std::to_string(largest / megabyte) + " MB");
    }
    refuse_control_characters(text, file);
    return text;
}

}  // namespace idim::generator
