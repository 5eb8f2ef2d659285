#include "model_cache.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "idim/private_folder.hpp"
#include "trusted_file.hpp"

namespace idim {

namespace {

constexpr const char* lock_suffix = ".lock";
constexpr const char* build_suffix = ".build-";

std::optional<std::filesystem::path> absolute_path_in(const char* variable) {
    const char* const value = std::getenv(variable);
    if (value == nullptr || !std::filesystem::path(value).is_absolute()) {
        return std::nullopt;
    }
    return value;
}

/// Without a trailing slash, which would make lstat follow a link.
std::filesystem::path plain(const std::filesystem::path& folder) {
    const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

std::optional<std::filesystem::path> named_cache(const std::string& wanted) {
    if (!wanted.empty()) {
        return plain(wanted);
    }
    if (const auto folder = absolute_path_in("XDG_CACHE_HOME")) {
        return plain(*folder / "idim");
    }
    const auto home = absolute_path_in("HOME");
    if (home && std::filesystem::is_directory(*home)) {  // of some accounts it is /nonexistent, and is to stay so
        return plain(*home / ".cache" / "idim");
    }
    return std::nullopt;
}

file_descriptor lock_file(const std::filesystem::path& file) {
    file_descriptor lock(open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
    while (!lock.is_open() || flock(lock.number(), LOCK_EX) != 0) {
        if (!lock.is_open() || errno != EINTR) {
            throw std::system_error(errno, std::generic_category(), file.string());
        }
    }
    return lock;
}

}  // namespace

std::optional<std::filesystem::path> usable_cache(const std::string& wanted) {
    try {
        const std::optional<std::filesystem::path> folder = named_cache(wanted);
        if (!folder) {
            return std::nullopt;
        }
        make_private_folder(*folder);
        require_trusted_folder(*folder);
        const bool usable = faccessat(AT_FDCWD, folder->c_str(), R_OK | W_OK | X_OK, AT_EACCESS) == 0;
        return usable ? folder : std::nullopt;
    } catch (const std::runtime_error&) {
        return std::nullopt;
    }
}

cache_slot::cache_slot(std::filesystem::path cache, std::string key)
    : cache_(std::move(cache)), key_(std::move(key)), lock_(lock_file(cache_ / (key_ + lock_suffix))) {}

// Unlocked by hand: a child that another thread forked meanwhile may still hold a copy of the descriptor.
cache_slot::~cache_slot() {
    flock(lock_.number(), LOCK_UN);
}

void cache_slot::clear() const {
    std::filesystem::remove_all(entry());
}

void cache_slot::replace(const std::function<void(const std::filesystem::path&)>& fill) const {
    clear();
    remove_abandoned();
    const private_folder build(cache_ / (key_ + build_suffix));
    fill(build.path());
    std::filesystem::rename(build.path(), entry());
}

/// Whoever holds the lock is the only one to build: what others left behind is of processes that died. The names differ
/// all the same, since the compiler that such a process started may still be writing.
void cache_slot::remove_abandoned() const {
    for (const std::filesystem::directory_entry& file : std::filesystem::directory_iterator(cache_)) {
        if (file.path().filename().string().rfind(key_ + build_suffix, 0) == 0) {
            std::error_code ignored;
            std::filesystem::remove_all(file.path(), ignored);
        }
    }
}

}  // namespace idim
