#include "log_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "idim/input_error.hpp"

namespace idim {
namespace {

constexpr size_t buffer_size = size_t{1} << 20;

bool is_gzip_name(const std::string& file) {
    return file.size() > 3 && file.compare(file.size() - 3, 3, ".gz") == 0;
}

}  // namespace

log_line_reader::log_line_reader(std::string file) : file_(std::move(file)), buffer_(buffer_size) {
    errno = 0;
    stream_ = gzopen(file_.c_str(), "rb");  // reads plain text as it is
    if (stream_ == nullptr) {
        throw input_error({file_, 0, ""}, std::string("cannot be opened: ") + std::strerror(errno));
    }
    try {
        fill();
        if (end_ > 0 && is_gzip_name(file_) && gzdirect(stream_) != 0) {
            throw input_error({file_, 0, ""}, "is named .gz but is not a gzip file");
        }
    } catch (...) {
        gzclose_r(stream_);
        throw;
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (std::string_view(buffer_.data(), end_).substr(0, byte_order_mark.size()) == byte_order_mark) {
        begin_ = byte_order_mark.size();
    }
}

log_line_reader::~log_line_reader() {
    gzclose_r(stream_);
}

void log_line_reader::fill() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) {
        buffer_.resize(2 * buffer_.size());
    }
    const int count = gzread(stream_, buffer_.data() + end_, static_cast<unsigned>(buffer_.size() - end_));
    int status = Z_OK;
    const char* message = gzerror(stream_, &status);
    // A truncated gzip file ends like a complete one, but leaves Z_BUF_ERROR behind (zlib.h, gzread).
    if (count < 0 || status == Z_BUF_ERROR) {
        const bool system_error = status == Z_ERRNO;
        throw input_error({file_, 0, ""}, system_error ? std::string("cannot be read: ") + std::strerror(errno)
                                                       : std::string("truncated or corrupt gzip file: ") + message);
    }
    end_ += static_cast<size_t>(count);
    at_end_ = count == 0;
}

bool log_line_reader::next(std::string_view& line) {
    size_t searched = begin_;
    for (;;) {
        const void* found = std::memchr(buffer_.data() + searched, '\n', end_ - searched);
        if (found != nullptr || (at_end_ && begin_ < end_)) {
            const size_t stop =
                found != nullptr ? static_cast<size_t>(static_cast<const char*>(found) - buffer_.data()) : end_;
            line = std::string_view(buffer_.data() + begin_, stop - begin_);
            begin_ = std::min(stop + 1, end_);
            if (!line.empty() && line.back() == '\r') {
                line.remove_suffix(1);
            }
            ++line_;
            return true;
        }
        if (at_end_) {
            return false;
        }
        const size_t pending = end_ - begin_;
        fill();
        searched = begin_ + pending;
    }
}

namespace {

/// Where a file is written until it is whole; of a device or pipe itself, as a file renamed over it would take its
/// place.
std::string temporary_name(const std::string& file) {
    std::error_code error;
    const bool is_special = std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
    return is_special ? file : file + ".tmp" + std::to_string(getpid());
}

}  // namespace

log_file_writer::log_file_writer(std::string file) : file_(std::move(file)), temporary_(temporary_name(file_)) {
    errno = 0;
    stream_ = gzopen(temporary_.c_str(), is_gzip_name(file_) ? "wb" : "wbT");  // T: no compression, no gzip header
    if (stream_ == nullptr) {
        throw input_error({file_, 0, ""}, std::string("cannot be written: ") + std::strerror(errno));
    }
}

log_file_writer::~log_file_writer() {
    if (stream_ != nullptr) {
        gzclose_w(stream_);
        remove_temporary();
    }
}

void log_file_writer::remove_temporary() {
    if (temporary_ != file_) {
        std::remove(temporary_.c_str());
    }
}

void log_file_writer::fail(const std::string& why) {
    remove_temporary();
    throw input_error({file_, 0, ""}, "cannot be written: " + why);
}

void log_file_writer::write(std::string_view text) {
    if (!text.empty() && gzwrite(stream_, text.data(), static_cast<unsigned>(text.size())) == 0) {
        int status = Z_OK;
        const std::string why = gzerror(stream_, &status);
        gzclose_w(std::exchange(stream_, nullptr));
        fail(why);
    }
}

void log_file_writer::commit() {
    errno = 0;
    if (gzclose_w(std::exchange(stream_, nullptr)) != Z_OK) {
        fail(std::strerror(errno));
    }
    if (temporary_ != file_ && std::rename(temporary_.c_str(), file_.c_str()) != 0) {
        fail(std::strerror(errno));
    }
}

}  // namespace idim
