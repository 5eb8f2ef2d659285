#include "emit/content_hash.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>

namespace idim::generator {

std::string content_hash(const std::string& text) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
    std::string hexadecimal;
    for (std::size_t i = 0; i < 8; ++i) {
        hexadecimal += fmt::format("{:02x}", digest[i]);
    }
    return hexadecimal;
}

}  // namespace idim::generator
