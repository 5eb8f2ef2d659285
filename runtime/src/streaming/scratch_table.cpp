#include "streaming/scratch_table.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "idim/input_error.hpp"

namespace idim {

namespace {

using row_major_rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::filesystem::path scratch_folder() {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) {
        throw input_error({"", 0, "TMPDIR"}, "names no folder, expected one for temporary files");
    }
    return folder;
}

[[noreturn]] void fail_scratch(const char* what) {
    const std::string why = std::strerror(errno);
    throw input_error({scratch_folder().string(), 0, ""},
                      std::string("a temporary file ").append(what).append(" there: ").append(why));
}

file_descriptor temporary_file() {
    std::string name = (scratch_folder() / "idim-XXXXXX").string();
    file_descriptor file(mkostemp(name.data(), O_CLOEXEC));
    if (!file.is_open()) {
        fail_scratch("cannot be made");
    }
    unlink(name.c_str());
    return file;
}

}  // namespace

scratch_table::scratch_table(Eigen::Index width) : file_(temporary_file()), width_(width) {}

void scratch_table::append(const Eigen::MatrixXd& rows) {
    const row_major_rows table = rows;
    try {
        write_all(file_, {reinterpret_cast<const char*>(table.data()),
                          static_cast<std::size_t>(table.size()) * sizeof(double)});
    } catch (const std::system_error& error) {
        errno = error.code().value();
        fail_scratch("cannot be written");
    }
    rows_ += rows.rows();
}

Eigen::MatrixXd scratch_table::read(Eigen::Index first, Eigen::Index count) const {
    row_major_rows table(count, width_);
    char* const bytes = reinterpret_cast<char*>(table.data());
    const std::size_t size = static_cast<std::size_t>(table.size()) * sizeof(double);
    const auto begin = static_cast<std::size_t>(first * width_) * sizeof(double);
    for (std::size_t done = 0; done < size;) {
        const ssize_t got = pread(file_.number(), bytes + done, size - done, static_cast<off_t>(begin + done));
        if (got > 0) {
            done += static_cast<std::size_t>(got);
        } else if (got == 0 || errno != EINTR) {
            fail_scratch("cannot be read");
        }
    }
    return table;
}

}  // namespace idim
