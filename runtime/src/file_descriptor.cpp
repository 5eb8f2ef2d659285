#include "file_descriptor.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace idim {

file_descriptor::~file_descriptor() {
    if (number_ >= 0) {
        close(number_);
    }
}

file_descriptor memory_file() {
    file_descriptor file(memfd_create("idim", MFD_CLOEXEC));
    if (!file.is_open()) {
        throw std::system_error(errno, std::generic_category(), "cannot make a file in memory");
    }
    return file;
}

std::string read_all(const file_descriptor& file) {
    std::string bytes;
    std::array<char, 65536> buffer;
    while (true) {
        const ssize_t got = pread(file.number(), buffer.data(), buffer.size(), static_cast<off_t>(bytes.size()));
        if (got == 0) {
            return bytes;
        }
        if (got > 0) {
            bytes.append(buffer.data(), static_cast<size_t>(got));
        } else if (errno != EINTR) {
            throw std::system_error(errno, std::generic_category(), "cannot read a file");
        }
    }
}

void write_all(const file_descriptor& file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t put = write(file.number(), bytes.data(), bytes.size());
        if (put >= 0) {
            bytes.remove_prefix(static_cast<size_t>(put));
        } else if (errno != EINTR) {
            throw std::system_error(errno, std::generic_category(), "cannot write a file");
        }
    }
}

}  // namespace idim
