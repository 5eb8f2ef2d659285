#include "emit/content_hash.hpp"

#include <sha2.h>

#include <array>

namespace idim::generator {

std::string content_hash(const std::string& text) {
    std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
    SHA256Data(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digits.data());
    return {digits.data(), 16};
}

}  // namespace idim::generator
