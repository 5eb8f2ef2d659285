#pragma once

#include <cstdint>
#include <optional>

#include "graph/rational.hpp"

namespace idim::generator {

/// Integers modulo the Mersenne prime 2^61 - 1. A matrix of rationals reduced to this field has at most the rank it has
/// over the rationals, so independence found here is proven there.
class prime_field {
  public:
    static constexpr std::uint64_t modulus = (std::uint64_t{1} << 61) - 1;

    prime_field() = default;
    explicit prime_field(std::uint64_t value) : value_(value % modulus) {}
    /// Throws std::domain_error where the denominator is a multiple of the modulus.
    explicit prime_field(const rational& value);

    bool is_zero() const { return value_ == 0; }
    std::uint64_t value() const { return value_; }
    /// Throws std::domain_error for zero.
    prime_field inverse() const;

    /// A root, or nothing where there is none, as for half of the elements.
    std::optional<prime_field> root() const;

    prime_field operator-() const { return prime_field(value_ == 0 ? 0 : modulus - value_); }
    friend prime_field operator+(prime_field a, prime_field b) { return reduced(a.value_ + b.value_); }
    friend prime_field operator-(prime_field a, prime_field b) { return reduced(a.value_ + modulus - b.value_); }
    friend prime_field operator*(prime_field a, prime_field b) {
        __extension__ using wide = unsigned __int128;
        const wide product = static_cast<wide>(a.value_) * b.value_;
        const auto low = static_cast<std::uint64_t>(product) & modulus;
        return reduced(low + static_cast<std::uint64_t>(product >> 61));
    }
    friend prime_field operator/(prime_field a, prime_field b) { return a * b.inverse(); }
    friend bool operator==(prime_field a, prime_field b) { return a.value_ == b.value_; }

  private:
    static prime_field reduced(std::uint64_t sum) {
        prime_field result;
        result.value_ = sum >= modulus ? sum - modulus : sum;
        return result;
    }

    static prime_field power(prime_field base, std::uint64_t exponent);

    std::uint64_t value_ = 0;
};

/// The rational of smallest size that the residue stands for; its numerator and denominator are below 2^30, or the
/// answer is zero with `found` false.
rational reconstruct(prime_field residue, bool& found);

}  // namespace idim::generator
