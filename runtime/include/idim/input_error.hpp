#pragma once

#include <stdexcept>
#include <string>

namespace idim {

/// Where in the user's input something stands; line 0 means the whole file, an empty field the whole line.
struct input_location {
    std::string file;
    int line = 0;
    std::string field;
};

/// Bad input. what() is one line: "file:line: field: message", the message saying what was expected.
/// The command turns it into exit status 2.
class input_error : public std::runtime_error {
  public:
    input_error(const input_location& where, const std::string& message)
        : std::runtime_error(describe(where) + message), where_(where) {}

    const input_location& where() const { return where_; }

  private:
    static std::string describe(const input_location& where) {
        std::string text = where.file;
        if (where.line > 0) {
            text.append(":").append(std::to_string(where.line));
        }
        if (!text.empty()) {
            text.append(": ");
        }
        if (!where.field.empty()) {
            text.append(where.field).append(": ");
        }
        return text;
    }

    input_location where_;
};

/// The data cannot support the answer (a parameter that is not excited, too few samples). Exit status 3.
class data_error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace idim
