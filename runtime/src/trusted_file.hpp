#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace idim {

// A file or folder is trusted if it is no link, belongs to the effective user, and neither group nor others may write
// it. Folders are made with mode 0700 and files with 0600, whatever the umask.

/// Throws std::runtime_error saying why `folder` is not trusted.
void require_trusted_folder(const std::filesystem::path& folder);

/// Content of a trusted regular file, checked on the very file that is read. Throws std::runtime_error if it is not
/// trusted or cannot be read.
std::string read_trusted_file(const std::filesystem::path& file);

/// Makes `folder` and those above it that are missing. Throws std::system_error.
void make_private_folder(const std::filesystem::path& folder);

/// Writes a new file, and the folders above it that are missing. Throws std::system_error, also if the file exists.
void write_private_file(const std::filesystem::path& file, std::string_view text);

/// Takes away the rights that a file made by another program may have given to group and others.
/// Throws std::system_error.
void make_file_private(const std::filesystem::path& file);

}  // namespace idim
