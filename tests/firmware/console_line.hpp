#pragma once

#include <cstdint>

/// One line of words on the console, written out at the end of its scope.
class console_line {
  public:
    console_line() = default;
    ~console_line();
    console_line(const console_line&) = delete;
    console_line& operator=(const console_line&) = delete;

    console_line& word(const char* text);
    console_line& number(std::uint32_t value);
    /// The bits of floats in hexadecimal, so that the reader has exactly these numbers.
    console_line& bits(const float* values, int count);

  private:
    void put(char letter);
    void put_number(std::uint32_t value, std::uint32_t base, int digits);

    static constexpr int size = 256;
    char text_[size];
    int length_ = 0;
};
