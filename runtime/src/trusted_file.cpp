#include "trusted_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "file_descriptor.hpp"

namespace idim {

namespace {

void require_private(const struct stat& status, const std::filesystem::path& path) {
    if (status.st_uid != geteuid()) {
        throw std::runtime_error(path.string() + " belongs to another user");
    }
    if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
        throw std::runtime_error(path.string() + " may be written by others");
    }
}

[[noreturn]] void fail(const std::filesystem::path& path) {
    throw std::system_error(errno, std::generic_category(), path.string());
}

}  // namespace

void require_trusted_folder(const std::filesystem::path& folder) {
    struct stat status {};
    if (lstat(folder.c_str(), &status) != 0) {
        fail(folder);
    }
    if (!S_ISDIR(status.st_mode)) {
        throw std::runtime_error(folder.string() + " is not a folder");
    }
    require_private(status, folder);
}

std::string read_trusted_file(const std::filesystem::path& file) {
    // O_NONBLOCK: a pipe of that name would otherwise block here, before its kind is known.
    const file_descriptor opened(open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (!opened.is_open() || fstat(opened.number(), &status) != 0) {
        fail(file);
    }
    if (!S_ISREG(status.st_mode)) {
        throw std::runtime_error(file.string() + " is not a regular file");
    }
    require_private(status, file);
    return read_all(opened);
}

void make_private_folder(const std::filesystem::path& folder) {
    if (std::filesystem::is_directory(folder)) {
        return;
    }
    if (folder.has_relative_path()) {
        make_private_folder(folder.parent_path());
    }
    if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
        fail(folder);
    }
}

void write_private_file(const std::filesystem::path& file, std::string_view text) {
    make_private_folder(file.parent_path());
    const file_descriptor opened(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
    if (!opened.is_open()) {
        fail(file);
    }
    write_all(opened, text);
}

void make_file_private(const std::filesystem::path& file) {
    const file_descriptor opened(open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!opened.is_open() || fchmod(opened.number(), S_IRUSR | S_IWUSR) != 0) {
        fail(file);
    }
}

}  // namespace idim
