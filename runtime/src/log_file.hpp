#pragma once

#include <zlib.h>

#include <string>
#include <string_view>
#include <vector>

namespace idim {

/// Lines of a plain or gzip text file, in one pass through a fixed buffer. Line ends LF or CRLF; a UTF-8 byte order
/// mark is dropped. Throws input_error if the file cannot be opened, is not gzip though named `.gz`, or is truncated or
/// corrupt gzip.
class log_line_reader {
  public:
    explicit log_line_reader(std::string file);
    ~log_line_reader();
    log_line_reader(const log_line_reader&) = delete;
    log_line_reader& operator=(const log_line_reader&) = delete;

    /// The next line without its end, valid until the next call; false at the end of the file.
    bool next(std::string_view& line);
    /// Number of the line that next() gave last, the first is 1.
    int line() const { return line_; }
    const std::string& file() const { return file_; }

  private:
    void fill();

    std::string file_;
    gzFile stream_ = nullptr;
    std::vector<char> buffer_;
    size_t begin_ = 0;  ///< first byte not yet given out
    size_t end_ = 0;    ///< past the last byte read
    bool at_end_ = false;
    int line_ = 0;
};

/// Writes a file, gzip if its name ends in `.gz`, under a temporary name beside it; commit() renames it. Without
/// commit() the file of that name stays as it was. A device or pipe is written into. Throws input_error if it cannot be
/// written.
class log_file_writer {
  public:
    explicit log_file_writer(std::string file);
    ~log_file_writer();
    log_file_writer(const log_file_writer&) = delete;
    log_file_writer& operator=(const log_file_writer&) = delete;

    void write(std::string_view text);
    void commit();

  private:
    [[noreturn]] void fail(const std::string& why);
    void remove_temporary();

    std::string file_;
    std::string temporary_;  ///< file_ itself where that is a device or pipe
    gzFile stream_ = nullptr;
};

}  // namespace idim
