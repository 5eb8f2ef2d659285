#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "file_descriptor.hpp"

namespace idim {

/// The folder `wanted`, else $XDG_CACHE_HOME/idim, else $HOME/.cache/idim; made if it is missing. Nothing if none is
/// named, or the one named is not trusted or cannot be written. A relative path in a variable is ignored
/// [XDG Base Directory Specification 0.8].
std::optional<std::filesystem::path> usable_cache(const std::string& wanted);

/// One entry of a cache folder, held against other processes and threads for as long as the object lives.
class cache_slot {
  public:
    /// Waits until no one else holds `key`. Throws std::system_error.
    cache_slot(std::filesystem::path cache, std::string key);
    ~cache_slot();
    cache_slot(const cache_slot&) = delete;
    cache_slot& operator=(const cache_slot&) = delete;

    std::filesystem::path entry() const { return cache_ / key_; }
    /// Removes the entry; of a link, the link. Throws std::system_error.
    void clear() const;
    /// Removes the entry, lets `fill` fill a new folder beside it, and makes that the entry: there is a whole entry or
    /// none. Throws what `fill` throws, and std::system_error.
    void replace(const std::function<void(const std::filesystem::path&)>& fill) const;

  private:
    void remove_abandoned() const;

    std::filesystem::path cache_;
    std::string key_;
    file_descriptor lock_;
};

}  // namespace idim
