#pragma once

#include <cmath>

/// A number and how far the same computation in single precision may be from it: a running error analysis (Higham,
/// Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.3). Each operation hands on the errors of its
/// arguments and adds half a unit in the last place of its result, u |result|, u = 2^-24. One rounding fewer, as in a
/// fused multiply-add, stays within the bound.
class rounded {
  public:
    rounded() = default;
    /// A constant of the code: rounded once.
    explicit rounded(double value)
        : value_(value), error_(static_cast<float>(value) == value ? 0.0 : rounding(value)) {}
    explicit rounded(int value) : value_(value) {}
    /// A number that both sides have.
    static rounded exact(float value) { return rounded(static_cast<double>(value), 0.0); }

    double value() const { return value_; }
    double error() const { return error_; }

    rounded operator-() const { return {-value_, error_}; }
    friend rounded operator+(rounded a, rounded b) { return after(a.value_ + b.value_, a.error_ + b.error_); }
    friend rounded operator-(rounded a, rounded b) { return a + -b; }
    friend rounded operator*(rounded a, rounded b) {
        return after(a.value_ * b.value_,
                     std::abs(a.value_) * b.error_ + std::abs(b.value_) * a.error_ + a.error_ * b.error_);
    }
    friend rounded operator/(rounded a, rounded b) {
        const double quotient = a.value_ / b.value_, smallest = std::abs(b.value_) - b.error_;
        return smallest > 0.0 ? after(quotient, (a.error_ + std::abs(quotient) * b.error_) / smallest)
                              : rounded(quotient, INFINITY);
    }
    friend bool operator>(rounded a, rounded b) { return a.value_ > b.value_; }
    friend bool operator<(rounded a, rounded b) { return a.value_ < b.value_; }

    /// The C library's sinf and cosf err by less than one unit in the last place, twice a rounding.
    friend rounded sin(rounded a) { return function(std::sin(a.value_), a.error_); }
    friend rounded cos(rounded a) { return function(std::cos(a.value_), a.error_); }

  private:
    rounded(double value, double error) : value_(value), error_(error) {}

    /// The double result is itself rounded, by 2^-53: the margin of 1 + 2^-20 covers it.
    static double rounding(double largest) { return std::abs(largest) * 0x1p-24 * (1.0 + 0x1p-20); }

    static rounded after(double value, double error) { return {value, error + rounding(std::abs(value) + error)}; }

    static rounded function(double value, double error) {
        return {value, error + 2.0 * rounding(std::abs(value) + error)};
    }

    double value_ = 0.0, error_ = 0.0;
};
