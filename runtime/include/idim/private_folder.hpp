#pragma once

#include <filesystem>

namespace idim {

/// A new folder for this user alone, removed with all it holds at the end of the scope. Throws std::system_error.
class private_folder {
  public:
    /// `prefix` is the path up to the part that makes it unique.
    explicit private_folder(const std::filesystem::path& prefix);
    ~private_folder();
    private_folder(const private_folder&) = delete;
    private_folder& operator=(const private_folder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace idim
