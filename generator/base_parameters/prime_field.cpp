#include "base_parameters/prime_field.hpp"

#include <cln/integer.h>

#include <stdexcept>
#include <utility>

namespace idim::generator {

namespace {

prime_field residue(const cln::cl_I& value) {
    const cln::cl_I p = cln::cl_I(static_cast<unsigned long>(prime_field::modulus));
    return prime_field(static_cast<std::uint64_t>(cln::cl_I_to_ulong(cln::mod(value, p))));
}

}  // namespace

prime_field::prime_field(const rational& value) {
    *this = residue(cln::numerator(value)) / residue(cln::denominator(value));
}

prime_field prime_field::inverse() const {
    if (is_zero()) {
        throw std::domain_error("no inverse of zero in a prime field");
    }
    return power(*this, modulus - 2);
}

std::optional<prime_field> prime_field::root() const {
    const prime_field candidate = power(*this, (modulus + 1) / 4);  // the modulus is 3 modulo 4
    return candidate * candidate == *this ? std::optional(candidate) : std::nullopt;
}

prime_field prime_field::power(prime_field base, std::uint64_t exponent) {
    prime_field result(std::uint64_t{1});
    for (; exponent != 0; exponent >>= 1) {
        if ((exponent & 1) != 0) {
            result = result * base;
        }
        base = base * base;
    }
    return result;
}

rational reconstruct(prime_field residue, bool& found) {
    constexpr std::int64_t bound = std::int64_t{1} << 30;
    // Extended Euclid stopped half way (Wang 1981): r = s * residue modulo p with both small.
    std::int64_t r0 = static_cast<std::int64_t>(prime_field::modulus);
    std::int64_t r1 = static_cast<std::int64_t>(residue.value());
    std::int64_t s0 = 0;
    std::int64_t s1 = 1;
    while (r1 >= bound) {
        const std::int64_t quotient = r0 / r1;
        r0 = std::exchange(r1, r0 - quotient * r1);
        s0 = std::exchange(s1, s0 - quotient * s1);
    }
    found = s1 != 0 && s1 < bound && s1 > -bound;
    return found ? cln::cl_I(static_cast<long>(r1)) / cln::cl_I(static_cast<long>(s1)) : rational(0);
}

}  // namespace idim::generator
