#include "idim/log.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "idim/input_error.hpp"
#include "log_file.hpp"

namespace idim {
namespace {

constexpr int not_there = -1;

std::string_view trim(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string_view unquote(std::string_view text) {
    text = trim(text);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
        text = trim(text.substr(1, text.size() - 2));
    }
    return text;
}

/// Header names; a comma between quotes belongs to the name.
std::vector<std::string> split_header(std::string_view line) {
    std::vector<std::string> names;
    size_t begin = 0;
    bool quoted = false;
    for (size_t k = 0; k <= line.size(); ++k) {
        if (k < line.size() && line[k] == '"') {
            quoted = !quoted;
        }
        if (k == line.size() || (line[k] == ',' && !quoted)) {
            names.emplace_back(unquote(line.substr(begin, k - begin)));
            begin = k + 1;
        }
    }
    return names;
}

std::string list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

std::string shortest_text(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// The header of a log and where each signal stands in it.
class log_header {
  public:
    log_header(std::string file, std::string_view line, const log_columns& columns)
        : file_(std::move(file)), names_(split_header(line)), joints_(columns.joint_names) {
        for (size_t k = 0; k < names_.size(); ++k) {
            if (!names_[k].empty() && std::find(names_.begin(), names_.begin() + k, names_[k]) != names_.begin() + k) {
                throw input_error({file_, 1, names_[k]}, "this column stands twice in the header");
            }
        }
        dof_ = joints_.empty() ? count_joints() : static_cast<int>(joints_.size());
    }

    int dof() const { return dof_; }
    const std::vector<std::string>& names() const { return names_; }

    /// Columns of `signal` joint by joint; empty if the header has none of them.
    std::vector<int> find(const std::string& signal) const {
        std::vector<int> columns;
        columns.reserve(static_cast<size_t>(dof_));
        for (int joint = 0; joint < dof_; ++joint) {
            columns.push_back(find(signal, joint));
        }
        const auto missing = std::find(columns.begin(), columns.end(), not_there);
        if (missing == columns.end()) {
            return columns;
        }
        if (std::all_of(columns.begin(), columns.end(), [](int column) { return column == not_there; })) {
            return {};
        }
        fail_missing(spellings(signal, static_cast<int>(missing - columns.begin())));
    }

    std::vector<int> require(const std::string& signal) const {
        std::vector<int> columns = find(signal);
        if (columns.empty()) {
            fail_missing(spellings(signal, 0));
        }
        return columns;
    }

    int require_time() const {
        const int column = index_of("t");
        if (column == not_there) {
            fail_missing("t");
        }
        return column;
    }

    [[noreturn]] void fail_missing(const std::string& what) const {
        throw input_error({file_, 1, what}, "this column is missing; the file has " + list(names_));
    }

    std::string spellings(const std::string& signal, int joint) const {
        const std::string numbered = signal + std::to_string(joint + 1);
        return joints_.empty() ? numbered : numbered + " (or " + signal + "_" + joints_[joint] + ")";
    }

  private:
    int index_of(const std::string& name) const {
        const auto found = std::find(names_.begin(), names_.end(), name);
        return found == names_.end() ? not_there : static_cast<int>(found - names_.begin());
    }

    int find(const std::string& signal, int joint) const {
        const int numbered = index_of(signal + std::to_string(joint + 1));
        const int named = joints_.empty() ? not_there : index_of(signal + "_" + joints_[joint]);
        if (numbered != not_there && named != not_there) {
            throw input_error({file_, 1, names_[named]}, "this column stands twice, also as " + names_[numbered]);
        }
        return std::max(numbered, named);
    }

    /// Largest k of any qk or qrk, so that a gap shows as a missing column.
    int count_joints() const {
        int joints = 1;
        for (const std::string& name : names_) {
            for (const std::string_view prefix : {"qr", "q"}) {
                int number = 0;
                const char* last = name.data() + name.size();
                if (name.starts_with(prefix) &&
                    std::from_chars(name.data() + prefix.size(), last, number).ptr == last &&
                    name.size() > prefix.size() && number <= static_cast<int>(names_.size())) {
                    joints = std::max(joints, number);
                }
            }
        }
        return joints;
    }

    std::string file_;
    std::vector<std::string> names_;
    std::vector<std::string> joints_;
    int dof_ = 0;
};

/// The numbers of the wanted columns, row after row.
struct number_table {
    std::vector<double> values;
    size_t width = 0;
    Eigen::Index rows() const { return width == 0 ? 0 : static_cast<Eigen::Index>(values.size() / width); }
};

class row_parser {
  public:
    /// slots[c] is the place of file column c in a row of the table, or not_there.
    row_parser(const log_line_reader& lines, const std::vector<std::string>& names, const std::vector<int>& slots)
        : lines_(lines), names_(names), slots_(slots) {}

    void parse(std::string_view line, double* row) const {
        size_t column = 0;
        for (;; ++column) {
            const size_t comma = line.find(',');
            if (column < names_.size() && slots_[column] != not_there) {
                row[slots_[column]] = number(line.substr(0, comma), column);
            }
            if (comma == std::string_view::npos) {
                break;
            }
            line.remove_prefix(comma + 1);
        }
        if (column + 1 != names_.size()) {
            const std::string field = column + 1 < names_.size() ? names_[column + 1] : "";
            throw input_error({lines_.file(), lines_.line(), field},
                              (column + 1 < names_.size() ? "too few fields, " : "too many fields, ") +
                                  std::to_string(column + 1) + " where the header has " +
                                  std::to_string(names_.size()));
        }
    }

  private:
    double number(std::string_view field, size_t column) const {
        const std::string_view text = unquote(field);
        const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
        double value = std::numeric_limits<double>::quiet_NaN();
        const auto [end, error] = std::from_chars(text.data() + plus, text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
            fail(text, column, error);
        }
        return value;
    }

    [[noreturn]] void fail(std::string_view text, size_t column, std::errc error) const {
        constexpr size_t shown = 40;
        const std::string quoted = "'" + std::string(text.substr(0, shown)) + (text.size() > shown ? "...'" : "'");
        throw input_error({lines_.file(), lines_.line(), names_[column]},
                          text.empty()                              ? "empty, a number was expected"
                          : error == std::errc::result_out_of_range ? quoted + " is out of the range of a double"
                                                                    : quoted + " where a finite number was expected");
    }

    const log_line_reader& lines_;
    const std::vector<std::string>& names_;
    const std::vector<int>& slots_;
};

/// A signal of the log and the file columns it comes from.
struct named_signal {
    Eigen::MatrixXd log::*signal;
    std::vector<int> columns;
};

bool all_gains_known(const log_columns& columns, int dof) {
    return static_cast<int>(columns.drive_gain.size()) >= dof &&
           std::none_of(columns.drive_gain.begin(), columns.drive_gain.begin() + dof,
                        [](double g) { return g == 0.0; });
}

void check_torque(const log_header& header, const log_columns& columns, const std::string& file) {
    if (!columns.torque_required || !header.find("tau").empty()) {
        return;
    }
    if (header.find("v").empty()) {
        header.fail_missing(header.spellings("tau", 0) + " or " + header.spellings("v", 0));
    }
    for (int joint = 0; joint < header.dof(); ++joint) {
        if (static_cast<size_t>(joint) >= columns.drive_gain.size() || columns.drive_gain[joint] == 0.0) {
            const std::string name =
                columns.joint_names.empty() ? std::to_string(joint + 1) : columns.joint_names[joint];
            throw input_error({file, 1, header.names()[header.find("v")[joint]]},
                              "a drive command needs the drive_gain of joint " + name + " in the robot description");
        }
    }
}

std::vector<named_signal> find_signals(const log_header& header, const log_columns& columns, const std::string& file) {
    const std::vector<int> reference = header.find("qr");
    const bool only_reference = !columns.torque_required && !reference.empty();
    std::vector<named_signal> signals;
    signals.push_back({&log::q, only_reference ? header.find("q") : header.require("q")});
    check_torque(header, columns, file);
    signals.push_back({&log::tau, header.find("tau")});
    signals.push_back({&log::v, header.find("v")});
    signals.push_back({&log::qr, reference});
    signals.push_back({&log::qd, header.find("qd")});
    signals.push_back({&log::qdd, header.find("qdd")});
    signals.push_back({&log::temp, header.find("temp")});
    return signals;
}

using row_major_table = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

log_header read_header(log_line_reader& lines, const log_columns& columns) {
    std::string_view line;
    if (!lines.next(line)) {
        throw input_error({lines.file(), 0, ""}, "the file is empty");
    }
    return {lines.file(), line, columns};
}

/// A log that is being read.
class open_log {
  public:
    open_log(const std::string& file, const log_columns& columns)
        : lines_(file),
          header_(read_header(lines_, columns)),
          slots_(header_.names().size(), not_there),
          parser_(lines_, header_.names(), slots_) {
        slots_[header_.require_time()] = 0;
        signals_ = find_signals(header_, columns, file);
        for (const named_signal& source : signals_) {
            for (const int column : source.columns) {
                slots_[column] = static_cast<int>(width_++);
            }
        }
        if (all_gains_known(columns, header_.dof())) {
            drive_gain_ = Eigen::Map<const Eigen::VectorXd>(columns.drive_gain.data(), header_.dof());
        }
    }

    log next(Eigen::Index most) {
        const number_table numbers = read_rows(most);
        const row_major_table table(numbers.values.data(), numbers.rows(), static_cast<Eigen::Index>(width_));
        log data;
        data.file = lines_.file();
        data.t = table.col(0);
        Eigen::Index first = 1;
        for (const named_signal& source : signals_) {
            const auto count = static_cast<Eigen::Index>(source.columns.size());
            if (count > 0) {
                data.*source.signal = table.middleCols(first, count);
                first += count;
            }
        }
        if (data.tau.size() == 0 && data.v.size() > 0 && drive_gain_.size() > 0) {
            data.tau = data.v * drive_gain_.asDiagonal();
        }
        return data;
    }

  private:
    number_table read_rows(Eigen::Index most) {
        number_table table;
        table.width = width_;
        std::string_view line;
        while (table.rows() < most && lines_.next(line)) {
            if (trim(line).empty()) {
                blank_line_ = blank_line_ == 0 ? lines_.line() : blank_line_;
                continue;
            }
            if (blank_line_ != 0) {
                throw input_error({lines_.file(), blank_line_, ""}, "blank line before the last row");
            }
            table.values.resize(table.values.size() + width_);
            double* const row = &table.values[table.values.size() - width_];
            parser_.parse(line, row);
            check_time(row[0]);
        }
        if (table.values.empty() && !started_) {
            throw input_error({lines_.file(), 0, ""}, "no rows after the header");
        }
        return table;
    }

    void check_time(double now) {
        if (started_ && !(now > last_time_)) {
            throw input_error(
                {lines_.file(), lines_.line(), "t"},
                "time must increase strictly, but " + shortest_text(now) + " follows " + shortest_text(last_time_));
        }
        started_ = true;
        last_time_ = now;
    }

    log_line_reader lines_;
    log_header header_;
    std::vector<int> slots_;  ///< place of every file column in a row of numbers, 0 the time
    row_parser parser_;
    std::vector<named_signal> signals_;
    size_t width_ = 1;
    Eigen::VectorXd drive_gain_;
    int blank_line_ = 0;
    bool started_ = false;
    double last_time_ = 0.0;
};

}  // namespace

log_reader::log_reader(const std::string& file, const log_columns& columns)
    : next_([open = std::make_shared<open_log>(file, columns)](Eigen::Index most) { return open->next(most); }) {}

log read_log(const std::string& file, const log_columns& columns) {
    return log_reader(file, columns).next(std::numeric_limits<Eigen::Index>::max());
}

void write_log(const std::string& file, const log& data) {
    const std::initializer_list<std::pair<const char*, const Eigen::MatrixXd*>> signals = {
        {"q", &data.q},   {"tau", &data.tau}, {"v", &data.v},      {"qr", &data.qr},
        {"qd", &data.qd}, {"qdd", &data.qdd}, {"temp", &data.temp}};
    const auto columns = [](const Eigen::MatrixXd& matrix) {
        return matrix.size() == 0 ? Eigen::Index{0} : matrix.cols();
    };
    std::string text = "t";
    for (const auto& [name, matrix] : signals) {
        if (matrix->size() > 0 && matrix->rows() != data.samples()) {
            throw std::invalid_argument("write_log: " + std::string(name) + " has " + std::to_string(matrix->rows()) +
                                        " rows, t has " + std::to_string(data.samples()));
        }
        for (Eigen::Index joint = 0; joint < columns(*matrix); ++joint) {
            text += "," + (name + std::to_string(joint + 1));
        }
    }
    text += '\n';
    log_file_writer writer(file);
    char number[32];
    const auto append = [&](double value) {
        text.append(number, std::to_chars(number, number + sizeof number, value).ptr);
    };
    for (Eigen::Index k = 0; k < data.samples(); ++k) {
        append(data.t[k]);
        for (const auto& [name, matrix] : signals) {
            for (Eigen::Index joint = 0; joint < columns(*matrix); ++joint) {
                text += ',';
                append((*matrix)(k, joint));
            }
        }
        text += '\n';
        writer.write(text);
        text.clear();
    }
    writer.write(text);
    writer.commit();
}

}  // namespace idim
