#include "console_line.hpp"

#include "board/board.h"

console_line::~console_line() {
    put('\n');
    text_[length_] = '\0';
    write_text(text_);
}

console_line& console_line::word(const char* text) {
    if (length_ > 0) {
        put(' ');
    }
    for (; *text != '\0'; ++text) {
        put(*text);
    }
    return *this;
}

console_line& console_line::number(std::uint32_t value) {
    word("");
    int digits = 1;
    for (std::uint32_t rest = value / 10U; rest > 0; rest /= 10U) {
        ++digits;
    }
    put_number(value, 10U, digits);
    return *this;
}

console_line& console_line::bits(const float* values, int count) {
    for (int i = 0; i < count; ++i) {
        std::uint32_t pattern = 0;
        static_assert(sizeof pattern == sizeof values[i]);
        __builtin_memcpy(&pattern, &values[i], sizeof pattern);
        word("");
        put_number(pattern, 16U, 8);
    }
    return *this;
}

void console_line::put(char letter) {
    if (length_ == size - 1) {
        text_[length_] = '\0';
        write_text(text_);
        length_ = 0;
    }
    text_[length_++] = letter;
}

void console_line::put_number(std::uint32_t value, std::uint32_t base, int digits) {
    char reversed[10];
    for (int i = 0; i < digits; ++i) {
        reversed[i] = "0123456789abcdef"[value % base];
        value /= base;
    }
    while (digits > 0) {
        put(reversed[--digits]);
    }
}
