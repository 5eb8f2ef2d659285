#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace idim {

/// An open file of the operating system, closed at the end of the scope; -1 is none.
class file_descriptor {
  public:
    explicit file_descriptor(int number = -1) : number_(number) {}
    ~file_descriptor();
    file_descriptor(file_descriptor&& other) noexcept : number_(other.release()) {}
    file_descriptor& operator=(file_descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }

    int number() const { return number_; }
    bool is_open() const { return number_ >= 0; }
    /// Gives the number away; the caller closes it.
    int release() { return std::exchange(number_, -1); }

  private:
    int number_;
};

/// A file in memory alone, readable and writable, not passed on to child processes. Throws std::system_error.
file_descriptor memory_file();

/// All bytes from the file's beginning. Throws std::system_error.
std::string read_all(const file_descriptor& file);

/// Writes all of `bytes` at the file's position. Throws std::system_error.
void write_all(const file_descriptor& file, std::string_view bytes);

}  // namespace idim
