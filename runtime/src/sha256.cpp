#include "sha256.hpp"

#include <sha2.h>

#include <array>

namespace idim {

std::string sha256(std::string_view bytes) {
    std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
    SHA256Data(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digits.data());
    return digits.data();
}

}  // namespace idim
