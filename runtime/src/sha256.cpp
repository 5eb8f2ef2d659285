#include "sha256.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>

namespace idim {

std::string sha256(std::string_view bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
    std::string digits;
    for (const unsigned char byte : digest) {
        digits += fmt::format("{:02x}", byte);
    }
    return digits;
}

}  // namespace idim
